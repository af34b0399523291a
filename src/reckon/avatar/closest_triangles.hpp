// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/shape/level_set.hpp"

namespace reckon {

inline constexpr std::uint32_t no_triangle = std::numeric_limits<std::uint32_t>::max();

/// For every vertex of a grid that is less than `reach` [m] away from a surface, the closest
/// triangle, of equally close ones the first, as TriangleBvh finds it; for all others no_triangle.
/// The grid's values are not looked at.
[[nodiscard]] std::vector<std::uint32_t> closest_triangles(const TriangleMesh& mesh,
                                                           const LevelSet& grid, double reach);

}  // namespace reckon
