// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "reckon/scan/volume.hpp"

namespace reckon {

/// Joins pieces of a watershed that no real neck divides: two neighbours become one grain when the
/// pass between them is more than `neck` times as deep as the shallower of both is at its deepest.
/// The widest necks are joined first. Returns how many pieces were joined to others. Labels keep
/// the lowest number of their pieces.
std::uint32_t join_wide_necks(LabelVolume& labels, const GrayVolume& depth, double neck);

/// Gives all labels consecutive numbers in the order of their first voxels. Returns their number.
std::uint32_t renumber(LabelVolume& labels);

/// A labelled grain's place in its volume.
struct LabelledGrain {
  std::array<std::int32_t, 3> low{0, 0, 0};   ///< least voxel along each axis
  std::array<std::int32_t, 3> high{0, 0, 0};  ///< largest
  std::uint64_t voxels{0};
  bool on_border{false};  ///< holds a voxel of the volume's outermost layers
};

/// All grains; the one with label n is at n - 1. Labels must be consecutive.
[[nodiscard]] std::vector<LabelledGrain> measure_labels(const LabelVolume& labels);

/// Which grains become avatars.
struct GrainChoice {
  std::vector<std::uint32_t> kept;  ///< labels, ascending
  std::uint32_t on_border{0};       ///< dropped because the volume cuts them off
  std::uint32_t tiny{0};            ///< dropped because they have too few voxels
};
[[nodiscard]] GrainChoice choose_grains(const std::vector<LabelledGrain>& grains, bool keep_border,
                                        std::uint64_t fewest_voxels);

/// Labels grown into unlabelled voxels, layer by layer through faces, `layers` times. Where two
/// meet at once the lower number wins.
[[nodiscard]] LabelVolume grown(const LabelVolume& labels, int layers);

}  // namespace reckon
