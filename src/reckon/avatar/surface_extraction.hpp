// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/shape/level_set.hpp"

namespace reckon {

/// The surface phi = 0 of a level set as a closed mesh in the body frame [m], outward.
///
/// Marching cubes (Lorensen & Cline 1987) without a case table: on every face of a cell the surface
/// leaves one or two segments between the cut edges; a cell's segments close to loops; each loop is
/// filled with triangles. Where a face has two possible pairs of segments, the one that the
/// bilinear interpolant on it has is taken (asymptotic decider, Nielson & Hamann 1991), so both
/// cells at the face agree and the mesh has no holes. Vertices lie where edges are cut; they keep
/// 1e-4 of a spacing away from grid vertices so that no triangle loses its area.
///
/// Throws Error when phi < 0 somewhere on the grid's outermost vertices: the surface would be open.
[[nodiscard]] TriangleMesh extract_surface(const LevelSetView& grid);

}  // namespace reckon
