// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reckon/scan/labels.hpp"
#include "reckon/scan/scan_avatars.hpp"

namespace reckon {

/// A place where grains may have been divided or joined wrongly.
struct Doubt {
  enum class Kind : std::uint8_t { split, join };
  Kind kind{Kind::split};
  std::uint32_t a{0};  ///< labels; the same for a join
  std::uint32_t b{0};
  double measure{0};  ///< split: area that faces the other over the cross-section; join: the waist
  VoxelDims voxel{};
};

/// Faces of voxels that the cross-section of a ball of this volume has on average over all
/// directions.
[[nodiscard]] double cross_section_in_faces(std::uint64_t voxels);

/// Pairs of labels that face each other, at most four voxels apart, over more than a good part of
/// the smaller one's cross-section: a crack, or two flat faces.
[[nodiscard]] std::vector<Doubt> doubtful_splits(const LabelsOnDisk& labels,
                                                 const std::vector<LabelledGrain>& grains,
                                                 const Workspace& work);
/// Grains that were joined across a waist, narrowest first; one doubt a grain.
[[nodiscard]] std::vector<Doubt> doubtful_joins(const std::vector<Waist>& waists);

/// A remark when splits are doubtful for more than a few of the grains.
[[nodiscard]] std::vector<std::string> check_doubts(const std::vector<Doubt>& splits,
                                                    std::size_t grains);

/// Implausible properties of a packing, in sentences with a likely cause. Empty when there are
/// none.
[[nodiscard]] std::vector<std::string> check_packing(const ScannedAssembly& assembly,
                                                     const std::vector<LabelledGrain>& grains,
                                                     const GrainChoice& choice,
                                                     const GrayLevels& levels);

/// Doubts from the figures of the scan itself: noise and blur.
[[nodiscard]] std::vector<std::string> check_scan(const StoredScan& scan, const MaskOnDisk& mask,
                                                  double spread);

}  // namespace reckon
