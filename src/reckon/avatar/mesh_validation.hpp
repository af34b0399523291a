// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// Throws Error, naming the fault, where it is and what to do, unless the mesh is the surface of
/// one solid body: finite vertices, valid indices, a size between 1e-9 and 1e6 m, no triangle
/// without area, every edge between exactly two triangles that agree which side is out, one part,
/// no vertex where the surface pinches itself, a positive volume, and no two triangles that touch
/// or cross. `name` is the file, or whatever made the mesh. Vertices and triangles are counted from
/// 0.
void require_closed_surface(const TriangleMesh& mesh, const std::string& name);

/// Whether a triangle has no area: it is lower than 1e-12 of the mesh's largest extent.
[[nodiscard]] bool is_flat(const TriangleMesh& mesh, const TriangleMesh::Triangle& triangle,
                           double extent);

}  // namespace reckon
