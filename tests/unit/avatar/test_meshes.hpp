// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon::test {

/// The cube [low, high]^3, 8 vertices, 12 triangles, outward.
inline TriangleMesh cube(double low = 0, double high = 1) {
  TriangleMesh mesh;
  for (int n = 0; n < 8; ++n) {
    mesh.vertices.push_back(
        {(n & 1) != 0 ? high : low, (n & 2) != 0 ? high : low, (n & 4) != 0 ? high : low});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// The tetrahedron of four points; outward when (b - a, c - a, d - a) is right-handed.
inline TriangleMesh tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {{a, b, c, d}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

/// Both meshes in one, not joined.
inline TriangleMesh together(TriangleMesh a, const TriangleMesh& b) {
  const auto shift = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const TriangleMesh::Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  return a;
}

}  // namespace reckon::test
