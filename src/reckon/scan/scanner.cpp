// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "reckon/avatar/random_variates.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/random.hpp"
#include "reckon/math/portable.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

constexpr int points_per_edge = 4;  // of a voxel; cubed they fill the bits of a word
constexpr double most_voxels = 2147483648.0;

void require(bool good, const char* setting, double value, const char* range) {
  if (good) return;
  throw Error{{.place = "scanner",
               .problem = fmt::format("{} is out of range", setting),
               .reason = fmt::format("{} was given, {} is allowed", value, range),
               .fix = "Choose a value in this range."}};
}

/// A grain as the scanner meets it: its grid and its pose in the volume.
struct Body {
  LevelSetView grid;
  Mat3 to_world;
  Vec3 position;
  double radius{0};
  std::uint32_t label{0};

  /// The level set at a point of the volume; outside the grid, where nothing is solid, a spacing.
  [[nodiscard]] double phi(const Vec3& world) const {
    const LevelSetView::Sample sample = grid.sample(transposed_times(to_world, world - position));
    return sample.inside_grid ? sample.phi : std::numeric_limits<double>::infinity();
  }
};

/// Which points of a voxel are solid.
std::uint64_t solid_points(const Body& body, const Vec3& center, double voxel) {
  std::uint64_t points = 0;
  std::uint64_t bit = 1;
  for (int c = 0; c < points_per_edge; ++c) {
    for (int b = 0; b < points_per_edge; ++b) {
      for (int a = 0; a < points_per_edge; ++a, bit <<= 1U) {
        const Vec3 place = Vec3{a + 0.5, b + 0.5, c + 0.5} / points_per_edge - Vec3{0.5, 0.5, 0.5};
        if (body.phi(center + voxel * place) < 0) points |= bit;
      }
    }
  }
  return points;
}

/// Fills layer k of the volume with solid shares and labels.
void fill_layer(const std::vector<Body>& bodies, const std::vector<double>& lipschitz,
                bool partial_volume, std::int32_t k, GrayVolume& gray, LabelVolume& labels) {
  const double voxel = gray.voxel;
  const std::size_t first = gray.index(0, 0, k);
  const std::size_t layer = gray.index(0, 0, 1);
  std::vector<std::uint64_t> points(layer, 0);
  std::vector<double> deepest(layer, 0);
  const double z = (k + 0.5) * voxel;
  for (std::size_t n = 0; n < bodies.size(); ++n) {
    const Body& body = bodies[n];
    const double reach = body.radius + voxel;
    if (std::abs(z - body.position.z) > reach) continue;
    const double half_diagonal = 0.87 * voxel * lipschitz[n];
    const auto from = [&](double center) {
      return std::max(0, static_cast<std::int32_t>(std::floor((center - reach) / voxel)));
    };
    const auto to = [&](double center, std::int32_t size) {
      return std::min(size - 1, static_cast<std::int32_t>(std::floor((center + reach) / voxel)));
    };
    for (std::int32_t j = from(body.position.y); j <= to(body.position.y, gray.dims[1]); ++j) {
      for (std::int32_t i = from(body.position.x); i <= to(body.position.x, gray.dims[0]); ++i) {
        const Vec3 center = gray.center_world(i, j, k);
        const double phi = body.phi(center);
        if (phi > half_diagonal && std::isfinite(phi)) continue;
        const std::size_t at = gray.index(i, j, 0);
        const bool near_surface = !(phi < -half_diagonal) && partial_volume;
        if (near_surface) {
          points[at] |= solid_points(body, center, voxel);
        } else if (phi < 0) {
          points[at] = ~std::uint64_t{0};
        }
        if (phi < deepest[at]) {
          deepest[at] = phi;
          labels.values[first + at] = body.label;
        }
      }
    }
  }
  for (std::size_t at = 0; at < layer; ++at) {
    gray.values[first + at] = static_cast<float>(std::popcount(points[at])) / 64.0F;
  }
}

/// Filters `width` lines that lie side by side: their numbers stand in rows, `stride` apart.
/// The vectors are scratch.
void blur_lines(float* values, std::size_t width, std::size_t length, std::size_t stride,
                const std::vector<float>& weights, std::vector<float>& padded,
                std::vector<float>& sum) {
  const std::size_t reach = weights.size() - 1;
  padded.resize(width * (length + 2 * reach));
  for (std::size_t n = 0; n < length + 2 * reach; ++n) {
    const std::size_t inside = std::clamp(n, reach, reach + length - 1) - reach;
    std::copy_n(values + inside * stride, width, padded.data() + n * width);
  }
  sum.resize(width * length);
  const float* const middle = padded.data() + reach * width;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = weights[0] * middle[i];
  for (std::size_t r = 1; r <= reach; ++r) {
    const float weight = weights[r];
    const float* const before = middle - r * width;
    const float* const after = middle + r * width;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * (before[i] + after[i]);
  }
  for (std::size_t n = 0; n < length; ++n) {
    std::copy_n(sum.data() + n * width, width, values + n * stride);
  }
}

/// Filters all lines along one axis.
void blur_axis(GrayVolume& volume, std::size_t axis, const std::vector<float>& weights) {
  const auto size = [&](std::size_t a) { return static_cast<std::size_t>(volume.dims[a]); };
  const std::size_t row = size(0);
  const std::size_t layer = row * size(1);
  float* const values = volume.values.data();
  parallel_for(size(axis == 2 ? 1 : 2), 1, [&](std::size_t n) {
    std::vector<float> padded;
    std::vector<float> sum;
    const auto blur = [&](float* first, std::size_t width, std::size_t length, std::size_t stride) {
      blur_lines(first, width, length, stride, weights, padded, sum);
    };
    if (axis == 2) {
      blur(values + n * row, row, size(2), layer);
    } else if (axis == 1) {
      blur(values + n * layer, row, size(1), row);
    } else {
      for (std::size_t j = 0; j < size(1); ++j) blur(values + n * layer + j * row, 1, row, 1);
    }
  });
}

/// From solid shares to gray values, before the point spread function.
void harden_beam(GrayVolume& gray, double loss) {
  const Vec3 axis{0.5 * gray.dims[0], 0.5 * gray.dims[1], 0};
  const double squared_radius = axis.x * axis.x + axis.y * axis.y;
  parallel_for(static_cast<std::size_t>(gray.dims[2]), 1, [&](std::size_t layer) {
    const auto k = static_cast<std::int32_t>(layer);
    for (std::int32_t j = 0; j < gray.dims[1]; ++j) {
      for (std::int32_t i = 0; i < gray.dims[0]; ++i) {
        const double x = i + 0.5 - axis.x;
        const double y = j + 0.5 - axis.y;
        const double factor = 1 - loss * (1 - (x * x + y * y) / squared_radius);
        float& value = gray.values[gray.index(i, j, k)];
        value = static_cast<float>(value * factor);
      }
    }
  });
}

void add_noise(GrayVolume& gray, const ScannerSettings& settings) {
  const std::size_t layer = gray.index(0, 0, 1);
  const double step = settings.solid_gray - settings.void_gray;
  parallel_for(static_cast<std::size_t>(gray.dims[2]), 1, [&](std::size_t k) {
    for (std::size_t at = k * layer; at < (k + 1) * layer; ++at) {
      double value = gray.values[at];
      if (settings.noise > 0) {
        RandomStream random{settings.seed, RandomPurpose::scan_noise, at};
        value += settings.noise * standard_normal(random);
      }
      gray.values[at] = static_cast<float>(settings.void_gray + step * value);
    }
  });
}

}  // namespace

void ScannerSettings::validate() const {
  require(voxel > 0 && std::isfinite(voxel), "the voxel's edge", voxel, "a length above zero");
  require(margin >= 0 && margin <= 1000, "the margin", margin, "0 to 1000 voxels");
  require(blur >= 0 && blur <= 10, "the blur", blur, "0 to 10 voxels");
  require(noise >= 0 && noise <= 1, "the noise", noise, "0 to 1");
  require(beam_hardening >= 0 && beam_hardening <= 0.5, "the beam hardening", beam_hardening,
          "0 to 0.5");
  require(std::isfinite(void_gray) && std::isfinite(solid_gray) && solid_gray > void_gray,
          "the gray of solid", solid_gray, "more than the gray of void");
}

void blur_volume(GrayVolume& volume, double deviation) {
  if (!(deviation > 0)) return;
  const auto reach = static_cast<std::size_t>(std::ceil(4 * deviation));
  std::vector<double> weights;
  double sum = 0;
  for (std::size_t r = 0; r <= reach; ++r) {
    const double distance = static_cast<double>(r) / deviation;
    weights.push_back(portable::exp(-0.5 * distance * distance));
    sum += (r == 0 ? 1 : 2) * weights.back();
  }
  std::vector<float> shares;
  shares.reserve(weights.size());
  for (const double weight : weights) shares.push_back(static_cast<float>(weight / sum));
  for (std::size_t axis = 0; axis < 3; ++axis) blur_axis(volume, axis, shares);
}

SimulatedScan scan_assembly(const std::vector<GrainState>& grains, const ReadShape& read_shape,
                            const ScannerSettings& settings) {
  settings.validate();
  if (grains.empty()) {
    throw Error{{.place = "scanner",
                 .problem = "there are no grains to scan",
                 .reason = {},
                 .fix = "Name a run or a scene with grains."}};
  }
  std::map<ShapeId, Shape> shapes;
  for (const GrainState& grain : grains) {
    if (!shapes.contains(grain.shape)) shapes.emplace(grain.shape, read_shape(grain.shape));
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low{infinity, infinity, infinity};
  Vec3 high = -low;
  for (const GrainState& grain : grains) {
    const double radius = shapes.at(grain.shape).bounding_radius;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], grain.position[axis] - radius);
      high[axis] = std::max(high[axis], grain.position[axis] + radius);
    }
  }
  std::array<std::int32_t, 3> dims{};
  double count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::ceil((high[axis] - low[axis]) / settings.voxel + 2 * settings.margin);
    count *= cells;
    require(count < most_voxels, "the voxel's edge", settings.voxel,
            "what makes fewer than 2^31 voxels");
    dims[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(cells);
  }

  SimulatedScan scan;
  scan.gray = GrayVolume{dims, settings.voxel};
  scan.labels = LabelVolume{dims, settings.voxel};
  const double margin = settings.margin * settings.voxel;
  const Vec3 corner = low - Vec3{margin, margin, margin};
  std::vector<Body> bodies;
  std::vector<double> lipschitz;
  for (const GrainState& grain : grains) {
    const Shape& shape = shapes.at(grain.shape);
    scan.grains.push_back(grain);
    scan.grains.back().position -= corner;
    scan.grains.back().orientation = normalized(grain.orientation);
    bodies.push_back({shape.level_set, rotation_matrix(scan.grains.back().orientation),
                      scan.grains.back().position, shape.bounding_radius,
                      static_cast<std::uint32_t>(bodies.size() + 1)});
    lipschitz.push_back(shape.lipschitz);
  }
  parallel_for(static_cast<std::size_t>(dims[2]), 1, [&](std::size_t k) {
    fill_layer(bodies, lipschitz, settings.partial_volume, static_cast<std::int32_t>(k), scan.gray,
               scan.labels);
  });
  if (settings.beam_hardening > 0) harden_beam(scan.gray, settings.beam_hardening);
  blur_volume(scan.gray, settings.blur);
  add_noise(scan.gray, settings);
  return scan;
}

}  // namespace reckon
