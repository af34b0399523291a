// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reckon/grains/grains.hpp"
#include "reckon/scan/segmentation.hpp"
#include "reckon/scan/volume.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// Two grains that touch or nearly do, and where.
struct NearPair {
  std::uint32_t a{0};  ///< places in the list of grains, a < b
  std::uint32_t b{0};
  double gap{0};      ///< least phi of one's nodes in the other's grid; negative: overlap [m]
  Vec3 point_world;   ///< that node [m]
  Vec3 normal_world;  ///< from a to b, unit length
};

/// All pairs with a gap of at most `reach` (which a grid knows up to its padding of two spacings),
/// sorted by a, then b. Uses all threads; the result does not depend on their number.
[[nodiscard]] std::vector<NearPair> near_pairs(std::span<const ShapeView> shapes,
                                               std::span<const GrainState> grains, double reach);

/// The gap between two grains as the gray values tell it [m]: the void share summed up along the
/// line through the pair's nearest point, along its normal, from inside one grain to inside the
/// other. Of the lines within five voxels of that one the line with the least sum is taken, and the
/// mean over those within a voxel of it, which evens out noise.
///
/// Blur spreads a thin gap over voxels whose gray stays above any threshold, but not its sum, which
/// is the gap's width averaged over the blur across the line: for a gap g between surfaces of
/// radius R it is g + s^2 / R with s the total deviation of the blur, the voxel's and that mean's
/// included [voxels].
[[nodiscard]] double gray_gap(const GrayVolume& gray, const GrayLevels& levels,
                              const NearPair& pair);

}  // namespace reckon
