// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/curved_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "reckon/avatar/creases.hpp"

namespace reckon {

CurvedSurface::CurvedSurface(const TriangleMesh& mesh) : mesh_{mesh} {
  struct Corner {
    std::uint32_t triangle;
    Vec3 weighted;  // normal times a weight that grows with the corner's angle
  };
  std::vector<std::vector<Corner>> around(mesh.vertices.size());
  std::vector<Vec3> face(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const TriangleMesh::Triangle& triangle = mesh.triangles[t];
    const auto at = [&](std::size_t c) { return mesh.vertices[triangle[c % 3]]; };
    face[t] = normalized(doubled_area_vector(mesh, triangle));
    for (std::size_t c = 0; c < 3; ++c) {
      // Max's weight (1999), sin(angle) / (product of the sides): exact for spheres.
      const Vec3 u = at(c + 1) - at(c);
      const Vec3 v = at(c + 2) - at(c);
      const double scale = squared_norm(u) * squared_norm(v);
      if (scale > 0) around[triangle[c]].push_back({t, cross(u, v) / scale});
    }
  }
  normals_.resize(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      Vec3 sum;
      for (const Corner& corner : around[mesh.triangles[t][c]]) {
        if (dot(face[corner.triangle], face[t]) >= crease_cosine) sum += corner.weighted;
      }
      normals_[t][c] = normalized(sum);
    }
  }
}

std::array<double, 3> CurvedSurface::weights(const ClosestPoint& on_mesh) const {
  const auto& [a, b, c] = mesh_.triangles[on_mesh.triangle];
  const Vec3 ab = mesh_.vertices[b] - mesh_.vertices[a];
  const Vec3 ac = mesh_.vertices[c] - mesh_.vertices[a];
  const Vec3 ap = on_mesh.point - mesh_.vertices[a];
  const Vec3 doubled = cross(ab, ac);
  const double scale = squared_norm(doubled);
  if (!(scale > 0)) return {1, 0, 0};
  const double to_b = dot(cross(ap, ac), doubled) / scale;
  const double to_c = dot(cross(ab, ap), doubled) / scale;
  return {1 - to_b - to_c, to_b, to_c};
}

Vec3 CurvedSurface::point(const ClosestPoint& on_mesh) const {
  const std::array<double, 3> weight = weights(on_mesh);
  Vec3 shift;
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3& normal = normals_[on_mesh.triangle][c];
    const Vec3& vertex = mesh_.vertices[mesh_.triangles[on_mesh.triangle][c]];
    shift -= (0.5 * weight[c] * dot(on_mesh.point - vertex, normal)) * normal;
  }
  return on_mesh.point + shift;
}

Vec3 CurvedSurface::normal(const ClosestPoint& on_mesh) const {
  const std::array<double, 3> weight = weights(on_mesh);
  Vec3 sum;
  for (std::size_t c = 0; c < 3; ++c) sum += weight[c] * normals_[on_mesh.triangle][c];
  return normalized(sum);
}

}  // namespace reckon
