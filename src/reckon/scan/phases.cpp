// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/phases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "reckon/core/error.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/labels.hpp"

namespace reckon {
namespace {

// In units of the step from void to solid.
constexpr double low_end = -0.5;
constexpr double high_end = 2.5;
constexpr std::size_t bins = 300;
constexpr double even = 0.08;           // difference to a neighbour on a plateau
constexpr double smoothing = 2.5;       // of the histogram [bins]
constexpr double least_height = 0.02;   // of a peak, over the highest
constexpr double deepest_valley = 0.6;  // beside a peak, over its height
constexpr double least_distance = 0.15;
constexpr double faint_below = 0.7;  // of the main solid
constexpr std::uint32_t ball_radius = 2;
constexpr int edge_layers = 3;

std::vector<double> plateau_histogram(const GrayOnDisk& gray, const MaskOnDisk& inside,
                                      const RoughLevels& levels, const Workspace& work) {
  std::vector<double> counts(bins, 0);
  const auto limit = static_cast<float>(even * levels.step());
  for (const Box& slab : work.slabs(gray.dims())) {
    const Box wide = slab.widened(1, gray.box());
    const GrayVolume part = gray.read(wide);
    const MaskVolume mask = inside.empty() ? MaskVolume{part, 1} : inside.read(wide);
    for_each_voxel(slab, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const std::size_t at = part.index(i, j, k);
      if (mask.values[at] == 0) return;
      const float here = part.values[at];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const std::int32_t step : {-1, 1}) {
          VoxelDims next{i, j, k};
          next[axis] += step;
          if (!part.holds(next[0], next[1], next[2])) continue;
          if (std::abs(part.values[part.index(next[0], next[1], next[2])] - here) > limit) return;
        }
      }
      const double share = (here - levels.void_gray) / levels.step();
      const double bin = (share - low_end) / (high_end - low_end) * static_cast<double>(bins);
      if (bin >= 0 && bin < static_cast<double>(bins)) counts[static_cast<std::size_t>(bin)] += 1;
    });
  }
  return counts;
}

std::vector<double> smoothed(const std::vector<double>& counts) {
  std::vector<double> smooth(counts.size(), 0);
  constexpr int reach = 8;
  for (std::size_t b = 0; b < counts.size(); ++b) {
    for (int n = -reach; n <= reach; ++n) {
      const auto from = static_cast<std::ptrdiff_t>(b) + n;
      if (from < 0 || from >= static_cast<std::ptrdiff_t>(counts.size())) continue;
      smooth[b] +=
          counts[static_cast<std::size_t>(from)] * std::exp(-0.5 * n * n / (smoothing * smoothing));
    }
  }
  return smooth;
}

/// Local maxima that rise above the valleys on the way to any higher one.
std::vector<std::size_t> peaks_of(const std::vector<double>& heights) {
  const double highest = *std::max_element(heights.begin(), heights.end());
  const auto valley = [&](std::size_t peak, int step) {
    double least = heights[peak];
    for (auto b = static_cast<std::ptrdiff_t>(peak);
         b >= 0 && b < static_cast<std::ptrdiff_t>(heights.size()); b += step) {
      const double height = heights[static_cast<std::size_t>(b)];
      if (height > heights[peak]) return least;
      least = std::min(least, height);
    }
    return 0.0;
  };
  std::vector<std::size_t> peaks;
  for (std::size_t b = 1; b + 1 < heights.size(); ++b) {
    if (!(heights[b] > heights[b - 1] && heights[b] >= heights[b + 1])) continue;
    if (heights[b] < least_height * highest) continue;
    if (std::max(valley(b, -1), valley(b, 1)) > deepest_valley * heights[b]) continue;
    peaks.push_back(b);
  }
  return peaks;
}

}  // namespace

std::optional<double> GrayPhases::faint() const {
  if (solid.size() < 2) return std::nullopt;
  const double share = (solid.front() - void_gray) / (main - void_gray);
  return share < faint_below ? std::optional{solid.front()} : std::nullopt;
}

std::uint32_t GrayPhases::phase_of(double gray) const {
  const auto nearest = std::min_element(solid.begin(), solid.end(), [&](double a, double b) {
    return std::abs(a - gray) < std::abs(b - gray);
  });
  return static_cast<std::uint32_t>(nearest - solid.begin()) + 1;
}

GrayPhases find_phases(const GrayOnDisk& gray, const MaskOnDisk& inside, const Workspace& work) {
  const RoughLevels levels = rough_levels(gray, inside, work);
  const std::vector<double> heights = smoothed(plateau_histogram(gray, inside, levels, work));
  const auto gray_of = [&](std::size_t bin) {
    const double share = low_end + (high_end - low_end) * (static_cast<double>(bin) + 0.5) /
                                       static_cast<double>(bins);
    return levels.void_gray + levels.step() * share;
  };
  GrayPhases phases;
  std::vector<std::size_t> peaks = peaks_of(heights);
  if (peaks.size() < 2) {
    phases.void_gray = levels.void_gray;
    phases.solid = {levels.solid_gray};
    phases.main = levels.solid_gray;
    return phases;
  }
  // Void is the peak next to the rough level, or the darkest.
  phases.void_gray = gray_of(peaks.front());
  double last = phases.void_gray;
  double highest = 0;
  for (std::size_t p = 1; p < peaks.size(); ++p) {
    const double here = gray_of(peaks[p]);
    if (here - last < least_distance * levels.step()) continue;
    phases.solid.push_back(here);
    last = here;
    if (heights[peaks[p]] <= highest) continue;
    highest = heights[peaks[p]];
    phases.main = here;
  }
  if (phases.solid.empty()) {
    phases.solid = {levels.solid_gray};
    phases.main = levels.solid_gray;
  }
  return phases;
}

GrayPhases given_phases(const std::vector<double>& grays) {
  const bool rise =
      std::adjacent_find(grays.begin(), grays.end(), std::greater_equal<>{}) == grays.end();
  if (grays.size() < 2 || !rise) {
    throw Error{{.place = "--grays",
                 .problem = "these are no grays of void and solid",
                 .reason = "the first is that of void, and each is above the one before it",
                 .fix = "Give --grays 9000,21000,40000, say. Where void is bright: --invert."}};
  }
  return {grays.front(), {grays.begin() + 1, grays.end()}, grays.back()};
}

MaskVolume faint_solid(const GrayVolume& gray, const GrayPhases& phases) {
  const double faint = *phases.faint();
  const double next = *std::upper_bound(phases.solid.begin(), phases.solid.end(), faint);
  const double low = 0.5 * (phases.void_gray + faint);
  const double high = 0.5 * (faint + next);
  MaskVolume between{gray};
  for (std::size_t v = 0; v < gray.values.size(); ++v) {
    between.values[v] = gray.values[v] > low && gray.values[v] < high ? 1 : 0;
  }
  const MaskVolume bodies = opened(between, ball_radius);
  LabelVolume seeds{gray};
  for (std::size_t v = 0; v < gray.values.size(); ++v) seeds.values[v] = bodies.values[v];
  const LabelVolume wide = grown(seeds, edge_layers);
  MaskVolume mask{gray};
  for (std::size_t v = 0; v < gray.values.size(); ++v) {
    mask.values[v] = wide.values[v] != 0 && gray.values[v] > low ? 1 : 0;
  }
  return mask;
}

}  // namespace reckon
