// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/shape/level_set.hpp"

namespace reckon {

/// A surface for pictures: closed, with normals for smooth shading.
struct DisplayMesh {
  TriangleMesh mesh;               ///< in the body frame [m]
  std::vector<Vec3> normals_unit;  ///< outward, by vertex
};

/// The surface phi = 0 of a level set with about `triangles` triangles, or all that its own grid
/// gives where these are fewer. Coarser surfaces are extracted from a coarser grid that samples
/// this one, and their vertices are then moved along the gradient onto the surface itself, so that
/// they lie on it to a small part of a grid spacing; only what is smaller than a triangle is lost.
[[nodiscard]] DisplayMesh display_mesh(const LevelSetView& grid, std::size_t triangles);

}  // namespace reckon
