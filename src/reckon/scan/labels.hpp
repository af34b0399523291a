// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "reckon/scan/volume.hpp"

namespace reckon {

/// Which necks between pieces of a watershed divide no grains.
struct NeckRules {
  /// Those wider than this share of the smaller piece: the depth of the pass over the depth where
  /// the shallower piece is deepest.
  double wide{0.95};
  /// With gray values: of those wider than `narrow` also those that are solid, because less than
  /// this share of the gray between void and the pieces' own solid is missing in the neck. Grains
  /// that merely touch leave void there, however blurred.
  double largest_void{0.03};
  double narrow{0.7};
  const GrayVolume* gray{nullptr};  ///< as scanned; or null
  double void_gray{0};
  double solid_gray{1};  ///< of pieces too small to tell their own
};

/// Joins pieces that no neck divides, at the widest first. Returns how many pieces were joined to
/// others. Labels keep the lowest number of their pieces.
std::uint32_t join_wide_necks(LabelVolume& labels, const GrayVolume& depth, const NeckRules& rules);

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
