// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/shape/level_set.hpp"

namespace reckon::test {

/// A grid over [-half, half]^3, shifted by `shift`, with the values of `phi` at its vertices.
template <class Function>
LevelSet cube_grid(double half, std::int32_t cells, const Vec3& shift, Function&& phi) {
  LevelSet grid;
  grid.dims = {cells + 1, cells + 1, cells + 1};
  grid.spacing = 2 * half / cells;
  grid.origin_body = Vec3{-half, -half, -half} + shift;
  for (std::int32_t k = 0; k <= cells; ++k) {
    for (std::int32_t j = 0; j <= cells; ++j) {
      for (std::int32_t i = 0; i <= cells; ++i) {
        grid.values.push_back(static_cast<float>(phi(grid.vertex_body(i, j, k))));
      }
    }
  }
  return grid;
}

/// Signed distance to the sphere of this radius about the origin.
inline auto sphere_distance(double radius) {
  return [radius](const Vec3& p) { return norm(p) - radius; };
}

/// The mesh with every vertex multiplied by `factors`, component by component.
inline TriangleMesh stretched(TriangleMesh mesh, const Vec3& factors) {
  for (Vec3& v : mesh.vertices) v = hadamard(v, factors);
  return mesh;
}

}  // namespace reckon::test
