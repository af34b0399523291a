// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// The curved surface whose chords a mesh is: its vertices lie on the surface. Phong tessellation
/// (Boubekeur & Alexa 2008) with the weight 1/2, which is exact to second order: a point of a
/// triangle goes half way to the mean of its feet on the tangent planes of the three vertices. The
/// normals of those are the means of the triangles around, weighted by angle, up to the next sharp
/// edge (crease_cosine), so that flat faces stay flat. The mesh must stay.
class CurvedSurface {
 public:
  explicit CurvedSurface(const TriangleMesh& mesh);

  [[nodiscard]] Vec3 point(const ClosestPoint& on_mesh) const;
  [[nodiscard]] Vec3 normal(const ClosestPoint& on_mesh) const;

 private:
  [[nodiscard]] std::array<double, 3> weights(const ClosestPoint& on_mesh) const;

  const TriangleMesh& mesh_;
  std::vector<std::array<Vec3, 3>> normals_;  // at each triangle's corners
};

}  // namespace reckon
