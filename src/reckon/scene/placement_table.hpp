// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "reckon/grains/grains.hpp"

namespace reckon {

/// Reads a table of poses: lines `shape, x, y, z, qw, qx, qy, qz`, comments with #. Ids count from
/// 0, quaternions are normalised. Throws Error naming file and line when a shape is not a whole
/// number below `shapes`, or a quaternion is zero.
[[nodiscard]] std::vector<GrainState> read_placement(const std::filesystem::path& file,
                                                     std::size_t shapes);

/// Writes such a table, numbers to their last bit.
void write_placement(const std::filesystem::path& file, std::span<const GrainState> grains);

}  // namespace reckon
