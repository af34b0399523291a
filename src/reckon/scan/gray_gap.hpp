// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "reckon/scan/near_pairs.hpp"
#include "reckon/scan/segmentation.hpp"
#include "reckon/scan/volume.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// Gray values along lines that cross the surface of a grain far from other grains.
class EdgeProfile {
 public:
  /// Adds the solid shares on the line through a point of the surface, along its outward normal.
  void add(const GrayVolume& gray, const GrayLevels& levels, const Vec3& point_world,
           const Vec3& normal_world);
  void add(const EdgeProfile& other);

  /// The standard deviation of the blur that the mean of all lines shows [voxels]: of the scanner,
  /// of the voxels' own extent, of filters, and of the interpolation between voxels. 1 when there
  /// are fewer than 200 lines.
  [[nodiscard]] double spread() const;

  static constexpr double reach = 3.5;  ///< of a line, to either side [voxels]

 private:
  static constexpr int half_steps = 14;
  std::array<double, 2 * half_steps + 1> sum_{};
  std::uint64_t lines_{0};
};

/// The smallest gap between two grains, from the gray values [m]; about 0 where they touch, and
/// below 0 only by noise.
///
/// The void shares summed up along a line across the gap are its width there, independent of blur,
/// averaged across the line over the blur. A paraboloid is fitted to these sums within two voxels
/// of the place, near `pair`, where they are least. Its lowest value, less what a blur of this
/// `spread` adds to a paraboloid (spread^2 / 2 times the sum of its principal curvatures), is the
/// gap, whatever the curvature of the grains.
///
/// `spread` is the standard deviation of the blur [voxels].
[[nodiscard]] double gray_gap(const GrayVolume& gray, const GrayLevels& levels,
                              const NearPair& pair, double spread);

}  // namespace reckon
