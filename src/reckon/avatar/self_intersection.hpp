// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// True when the triangles (a, b, c) of a mesh, given by their indices, meet anywhere but in the
/// vertices and the edge that they share. Touching counts as meeting; the answer is exact.
/// Both triangles must have an area.
[[nodiscard]] bool triangles_meet(const TriangleMesh& mesh, std::uint32_t first,
                                  std::uint32_t second);

/// The lowest pair of triangles that meet though they should not, if any. Every triangle must have
/// an area, and the mesh must be one that TriangleBvh accepts.
[[nodiscard]] std::optional<std::pair<std::uint32_t, std::uint32_t>> first_self_intersection(
    const TriangleMesh& mesh);

}  // namespace reckon
