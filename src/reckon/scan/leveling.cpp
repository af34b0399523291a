// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/leveling.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

constexpr std::size_t gray_bins = 256;
constexpr int cells_per_edge = 5;  // of the volume's shortest
constexpr std::int32_t least_cell = 18;
constexpr std::size_t most_cells = 20000;
constexpr double even = 0.25;            // difference to a neighbour, in steps, away from edges
constexpr double least_class = 0.1;      // of a cell's voxels, for both phases to be there
constexpr double least_change = 0.06;    // of the step, that is levelled
constexpr double least_explained = 0.7;  // of the variance between cells, by the polynomial
constexpr double least_gain = 0.2;       // where the fit would fall below, of the mean
constexpr int rounds = 3;
constexpr std::size_t looks_per_term = 5;

/// Where a polynomial is fitted and evaluated: from -1 to 1 along each edge of the volume.
std::array<double, 3> scaled(const VoxelDims& dims, double x, double y, double z) {
  return {2 * x / dims[0] - 1, 2 * y / dims[1] - 1, 2 * z / dims[2] - 1};
}

/// A polynomial of three variables.
class Polynomial {
 public:
  static std::size_t terms_of(int degree) {
    return static_cast<std::size_t>((degree + 1) * (degree + 2) * (degree + 3) / 6);
  }
  explicit Polynomial(int degree) : degree_{degree}, factors_(terms_of(degree), 0) {}
  /// Calls visit(term, value) for each product of powers.
  template <class Visit>
  void for_each_term(const std::array<double, 3>& p, Visit&& visit) const {
    std::size_t term = 0;
    double x = 1;
    for (int a = 0; a <= degree_; ++a) {
      double xy = x;
      for (int b = 0; a + b <= degree_; ++b) {
        double xyz = xy;
        for (int c = 0; a + b + c <= degree_; ++c) {
          visit(term++, xyz);
          xyz *= p[2];
        }
        xy *= p[1];
      }
      x *= p[0];
    }
  }
  /// No farther out than where it was fitted.
  [[nodiscard]] double at(std::array<double, 3> p) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = std::clamp(p[axis], low_[axis], high_[axis]);
    double sum = 0;
    for_each_term(p, [&](std::size_t term, double value) { sum += factors_[term] * value; });
    return sum;
  }
  [[nodiscard]] std::size_t terms() const { return factors_.size(); }
  std::vector<double>& factors() { return factors_; }
  void hold(const std::array<double, 3>& low, const std::array<double, 3>& high) {
    low_ = low;
    high_ = high;
  }

 private:
  int degree_;
  std::vector<double> factors_;
  std::array<double, 3> low_{-1, -1, -1};
  std::array<double, 3> high_{1, 1, 1};
};

/// A gray, or a step between grays, at a place.
struct Look {
  std::array<double, 3> place{};
  double value{0};
};

/// A polynomial fitted to the samples, and the quality of the fit.
struct Fit {
  Polynomial polynomial{0};
  double mean{0};
  double change{0};     // of the polynomial: max minus min at the samples
  double explained{0};  // share of the variance of the samples
};

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void solve(const std::vector<Look>& looks, Polynomial& polynomial) {
  const auto rows = static_cast<Eigen::Index>(looks.size());
  const auto columns = static_cast<Eigen::Index>(polynomial.terms());
  Eigen::MatrixXd matrix(rows, columns);
  Eigen::VectorXd values(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Look& look = looks[static_cast<std::size_t>(row)];
    polynomial.for_each_term(look.place, [&](std::size_t term, double value) {
      matrix(row, static_cast<Eigen::Index>(term)) = value;
    });
    values(row) = look.value;
  }
  const Eigen::VectorXd factors = matrix.colPivHouseholderQr().solve(values);
  for (Eigen::Index term = 0; term < columns; ++term) {
    polynomial.factors()[static_cast<std::size_t>(term)] = factors(term);
  }
}

/// Samples far off the polynomial are dropped, and it is fitted again. `half_cell`: the range of a
/// sample, on either side along each axis.
Fit fit_of(std::vector<Look> looks, const std::array<double, 3>& half_cell) {
  constexpr int fits = 4;
  constexpr double far_off = 4;  // times the median distance
  Fit fit;
  int degree = 3;
  while (degree > 0 && looks.size() < looks_per_term * Polynomial::terms_of(degree)) --degree;
  fit.polynomial = Polynomial{degree};
  if (looks.empty()) return fit;
  std::array<double, 3> low = looks.front().place;
  std::array<double, 3> high = low;
  for (const Look& look : looks) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], look.place[axis]);
      high[axis] = std::max(high[axis], look.place[axis]);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] -= half_cell[axis];
    high[axis] += half_cell[axis];
  }
  fit.polynomial.hold(low, high);
  for (int n = 0; n < fits; ++n) {
    solve(looks, fit.polynomial);
    std::vector<double> off;
    off.reserve(looks.size());
    for (const Look& look : looks) {
      off.push_back(std::abs(look.value - fit.polynomial.at(look.place)));
    }
    const double limit = far_off * median_of(off) + 1e-12;
    std::vector<Look> near;
    for (std::size_t l = 0; l < looks.size(); ++l) {
      if (off[l] <= limit) near.push_back(looks[l]);
    }
    if (near.size() == looks.size() || near.size() < 2 * fit.polynomial.terms()) break;
    looks = std::move(near);
  }
  double least = fit.polynomial.at(looks.front().place);
  double most = least;
  for (const Look& look : looks) {
    const double value = fit.polynomial.at(look.place);
    fit.mean += look.value / static_cast<double>(looks.size());
    least = std::min(least, value);
    most = std::max(most, value);
  }
  double left = 0;
  double all = 0;
  for (const Look& look : looks) {
    left += std::pow(look.value - fit.polynomial.at(look.place), 2);
    all += std::pow(look.value - fit.mean, 2);
  }
  fit.change = most - least;
  fit.explained = all > 0 ? 1 - left / all : 0;
  return fit;
}

/// The volume in cells, with a histogram of each.
class Cells {
 public:
  /// `limit`: of the difference to a neighbour, for a voxel that counts.
  Cells(const Specimen& specimen, double low, double high, double limit, const Workspace& work)
      : dims_{specimen.gray.dims()}, low_{low}, high_{high} {
    edge_ = std::max(least_cell, *std::min_element(dims_.begin(), dims_.end()) / cells_per_edge);
    const auto count = [&] {
      std::size_t cells = 1;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        grid_[axis] = (dims_[axis] + edge_ - 1) / edge_;
        cells *= static_cast<std::size_t>(grid_[axis]);
      }
      return cells;
    };
    while (count() > most_cells) edge_ += edge_ / 4;
    counts_.resize(count());
    for (const Box& slab : work.slabs(dims_)) {
      const Box wide = slab.widened(1, specimen.gray.box());
      const GrayVolume gray = specimen.gray.read(wide);
      const MaskVolume mask =
          specimen.inside.empty() ? MaskVolume{gray, 1} : specimen.inside.read(wide);
      for_each_voxel(slab, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
        const std::size_t at = gray.index(i, j, k);
        if (mask.values[at] == 0) return;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          for (const std::int32_t step : {-1, 1}) {
            VoxelDims next{i, j, k};
            next[axis] += step;
            if (!gray.holds(next[0], next[1], next[2])) continue;
            const float other = gray.values[gray.index(next[0], next[1], next[2])];
            if (std::abs(static_cast<double>(other - gray.values[at])) > limit) return;
          }
        }
        auto& counts = counts_[index(i / edge_, j / edge_, k / edge_)];
        if (counts.empty()) counts.resize(gray_bins, 0);
        const double bin =
            (gray.values[at] - low_) / (high_ - low_) * static_cast<double>(gray_bins);
        ++counts[static_cast<std::size_t>(
            std::clamp(bin, 0.0, static_cast<double>(gray_bins) - 1))];
      });
    }
  }

  /// Half of a cell's edge, as places are scaled.
  [[nodiscard]] std::array<double, 3> half_cell() const {
    std::array<double, 3> half{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      half[axis] = static_cast<double>(edge_) / dims_[axis];
    }
    return half;
  }

  /// Calls visit(place, both levels, the dark class's share) for cells that are
  /// not nearly empty.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for_each_voxel(Box{grid_}, [&](std::int32_t a, std::int32_t b, std::int32_t c) {
      const auto& counts = counts_[index(a, b, c)];
      std::uint64_t total = 0;
      for (const std::uint64_t count : counts) total += count;
      if (10 * total < static_cast<std::uint64_t>(edge_) * static_cast<std::uint64_t>(edge_) *
                           static_cast<std::uint64_t>(edge_)) {
        return;
      }
      const RoughLevels levels = rough_levels(counts, low_, high_);
      const double width = (high_ - low_) / static_cast<double>(gray_bins);
      std::uint64_t dark = 0;
      for (std::size_t bin = 0; bin < gray_bins; ++bin) {
        if (low_ + width * (static_cast<double>(bin) + 0.5) < levels.threshold) dark += counts[bin];
      }
      const double share = static_cast<double>(dark) / static_cast<double>(total);
      visit(scaled(dims_, (a + 0.5) * edge_, (b + 0.5) * edge_, (c + 0.5) * edge_), levels, share);
    });
  }

 private:
  [[nodiscard]] std::size_t index(std::int32_t a, std::int32_t b, std::int32_t c) const {
    return static_cast<std::size_t>((std::int64_t{c} * grid_[1] + b) * grid_[0] + a);
  }

  VoxelDims dims_;
  double low_;
  double high_;
  std::int32_t edge_{0};
  VoxelDims grid_{};
  std::vector<std::vector<std::uint64_t>> counts_;
};

struct Shading {
  Fit background;  // gray of void
  Fit step;        // from void to solid
};

Shading measure(const Specimen& specimen, const Workspace& work) {
  const RoughLevels rough = rough_levels(specimen.gray, specimen.inside, work);
  const Cells cells{specimen, rough.void_gray - 1.5 * rough.step(),
                    rough.void_gray + 2.5 * rough.step(), even * rough.step(), work};
  std::vector<double> steps;
  cells.for_each([&](const auto&, const RoughLevels& levels, double dark) {
    if (dark > least_class && dark < 1 - least_class) steps.push_back(levels.step());
  });
  Shading shading;
  if (steps.empty()) return shading;
  // Noise alone is divided too, but not by much.
  std::sort(steps.begin(), steps.end());
  const double typical = steps[steps.size() * 3 / 4];
  std::vector<Look> voids;
  std::vector<Look> gains;
  cells.for_each([&](const auto& place, const RoughLevels& levels, double dark) {
    if (dark < least_class || dark > 1 - least_class || levels.step() < 0.5 * typical) return;
    voids.push_back({place, levels.void_gray});
    gains.push_back({place, levels.step()});
  });
  const Fit first = fit_of(voids, cells.half_cell());
  // Cells with only void: their middle is near that of the others.
  cells.for_each([&](const auto& place, const RoughLevels& levels, double) {
    if (levels.step() >= 0.5 * typical) return;
    const double middle = 0.5 * (levels.void_gray + levels.solid_gray);
    if (std::abs(middle - first.polynomial.at(place)) < 0.3 * typical) {
      voids.push_back({place, middle});
    }
  });
  shading.background = fit_of(std::move(voids), cells.half_cell());
  shading.step = fit_of(std::move(gains), cells.half_cell());
  return shading;
}

bool is_shaded(const Fit& fit, double step) {
  return fit.change > least_change * step && fit.explained > least_explained;
}

GrayOnDisk leveled(const GrayOnDisk& gray, const Shading& shading, bool background, bool gain,
                   const Workspace& work) {
  GrayOnDisk result{gray.dims(), gray.voxel(), work.folder};
  const double void_gray = shading.background.mean;
  const double step = shading.step.mean;
  for (const Box& slab : work.slabs(gray.dims())) {
    GrayVolume part = gray.read(slab);
    parallel_for(static_cast<std::size_t>(slab.dims[2]), 1, [&](std::size_t layer) {
      Box voxels = slab;
      voxels.low[2] += static_cast<std::int32_t>(layer);
      voxels.dims[2] = 1;
      for_each_voxel(voxels, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
        const auto place = scaled(gray.dims(), i + 0.5, j + 0.5, k + 0.5);
        const double here = background ? shading.background.polynomial.at(place) : void_gray;
        const double factor =
            gain ? 1 / std::max(least_gain, shading.step.polynomial.at(place) / step) : 1.0;
        float& value = part.values[part.index(i, j, k)];
        value = static_cast<float>(void_gray + (value - here) * factor);
      });
    });
    result.write(part, slab);
  }
  return result;
}

}  // namespace

void level_gray(Specimen& specimen, const Workspace& work) {
  double background_change = 0;
  double gain_change = 0;
  for (int round = 0; round < rounds; ++round) {
    const Shading shading = measure(specimen, work);
    const double step = shading.step.mean;
    if (!(step > 0)) break;
    const bool background = is_shaded(shading.background, step);
    const bool gain = is_shaded(shading.step, step);
    if (!background && !gain) break;
    if (background)
      background_change = std::max(background_change, shading.background.change / step);
    if (gain) gain_change = std::max(gain_change, shading.step.change / step);
    specimen.gray = leveled(specimen.gray, shading, background, gain, work);
  }
  if (background_change == 0 && gain_change == 0) return;
  specimen.remarks.push_back(
      fmt::format("shading was levelled: over the volume the gray of void changes by {:.0f} % and "
                  "the step from void to solid by {:.0f} % of the mean step (--keep-shading leaves "
                  "them)",
                  100 * background_change, 100 * gain_change));
}

}  // namespace reckon
