// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "reckon/shape/level_set.hpp"

namespace reckon {

/// Parses a level-set grid as LAMMPS-style text: a comment line, then nx ny nz, spacing, origin,
/// and one value per grid vertex, x fastest, negative inside. Lengths are multiplied by
/// `unit_in_metres`. The frame is the file's own: make a shape of it by extract_surface and
/// build_shape. Throws Error naming the line.
[[nodiscard]] LevelSet parse_level_set_text(std::string_view text, const std::string& name,
                                            double unit_in_metres);

}  // namespace reckon
