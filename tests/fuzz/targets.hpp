// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "target.hpp"

namespace reckon::fuzz {

[[nodiscard]] Target scene_target();
[[nodiscard]] Target stl_target();
[[nodiscard]] Target obj_target();
[[nodiscard]] Target ply_target();
[[nodiscard]] Target spherical_harmonics_target();
[[nodiscard]] Target degree_table_target();
[[nodiscard]] Target legacy_morphology_target();
[[nodiscard]] Target legacy_shape_target();
[[nodiscard]] Target legacy_positions_target();
[[nodiscard]] Target legacy_rotations_target();
[[nodiscard]] Target level_set_text_target();
[[nodiscard]] Target shape_library_target();
[[nodiscard]] Target checkpoint_target();
[[nodiscard]] Target fields_target();
[[nodiscard]] Target membrane_target();
[[nodiscard]] Target history_target();
[[nodiscard]] Target number_table_target();
[[nodiscard]] Target placement_target();
[[nodiscard]] Target volume_npy_target();
[[nodiscard]] Target volume_raw_target();
/// MetaImage, NRRD and TIFF, plain and compressed.
[[nodiscard]] std::vector<Target> image_targets();

}  // namespace reckon::fuzz
