// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reckon/scan/labels.hpp"

namespace reckon {

/// Given labels, divided into connected pieces.
struct LabelPieces {
  LabelsOnDisk labels;               ///< consecutive from 1, in the order of their first voxels
  std::vector<std::uint32_t> given;  ///< by piece - 1: its label as it was given
};
/// Voxels of one label are connected through faces. The result does not depend on the slabs that
/// are read at a time.
[[nodiscard]] LabelPieces find_label_pieces(const LabelsOnDisk& given, const Workspace& work);

/// Sets what grains were called before: LabelledGrain::given and ::piece, by falling size.
void name_by_label(std::vector<LabelledGrain>& grains, const LabelPieces& pieces);

/// Remarks on the labels: those of several pieces that are large enough to be grains, and a mask
/// that was taken for labels.
[[nodiscard]] std::vector<std::string> label_remarks(const std::vector<LabelledGrain>& grains,
                                                     std::uint64_t fewest_voxels);

}  // namespace reckon
