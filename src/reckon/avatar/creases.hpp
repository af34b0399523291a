// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// A run of sharp edges of a surface, from corner to corner, or closed.
struct Crease {
  std::vector<std::uint32_t> vertices;  ///< along it; a closed one does not repeat the first
  bool closed{false};
};

/// Two triangles meet sharply where their normals differ by more than this [cosine]: 40 degrees. A
/// smooth surface whose radii are above 0.4 voxels turns by less across a mesh edge of half a
/// voxel, edge to edge.
inline constexpr double crease_cosine = 0.7660444431189780;

/// All sharp edges of a closed surface as creases. They end at corners: vertices where other than
/// two sharp edges meet, or where the two turn by more than 40 degrees.
[[nodiscard]] std::vector<Crease> creases_of(const TriangleMesh& mesh);

/// The places along a crease [m]; a closed one ends where it begins.
[[nodiscard]] std::vector<Vec3> line_along(const TriangleMesh& mesh, const Crease& crease);

/// Points on the creases about `spacing` apart [m]: all corners that end them, and evenly between;
/// creases shorter than half a spacing have none of their own. In a fixed order.
[[nodiscard]] std::vector<Vec3> points_on_creases(const TriangleMesh& mesh,
                                                  const std::vector<Crease>& creases,
                                                  double spacing);

}  // namespace reckon
