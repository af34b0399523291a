// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// A closed surface made of triangles. Every edge belongs to two triangles, and vertices are
/// counter-clockwise when seen from outside.
struct TriangleMesh {
  using Triangle = std::array<std::uint32_t, 3>;

  std::vector<Vec3> vertices;       ///< [m]
  std::vector<Triangle> triangles;  ///< indices into vertices
};

/// The outward normal of a triangle, as long as twice its area [m^2].
[[nodiscard]] inline Vec3 doubled_area_vector(const TriangleMesh& mesh,
                                              const TriangleMesh::Triangle& triangle) {
  const Vec3& a = mesh.vertices[triangle[0]];
  return cross(mesh.vertices[triangle[1]] - a, mesh.vertices[triangle[2]] - a);
}
[[nodiscard]] inline double triangle_area(const TriangleMesh& mesh,
                                          const TriangleMesh::Triangle& triangle) {
  return 0.5 * norm(doubled_area_vector(mesh, triangle));  // [m^2]
}

}  // namespace reckon
