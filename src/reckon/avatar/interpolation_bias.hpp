// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "reckon/avatar/creases.hpp"
#include "reckon/avatar/curved_surface.hpp"
#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/shape/level_set.hpp"

namespace reckon {

/// Makes the distances to a mesh near its surface those to the curved surface whose chords the mesh
/// is. `bvh` is that of the mesh.
void measure_to_curved_surface(LevelSet& grid, const TriangleBvh& bvh,
                               const CurvedSurface& surface);

/// Shifts distances so that the zero of their trilinear interpolant lies on the surface.
///
/// In a cell, at the place (x, y, z) in [0, 1]^3, the interpolant of a smooth function exceeds it
/// by h^2/2 times the sum of x (1 - x) d2phi/dx2 over the axes. That is h^2/12 times the Laplacian
/// on average, so without correction the zero lies about h^2 / (6 R) inside a sphere. The Laplacian
/// comes from the six neighbours of each vertex within 0.75 spacings of the surface; vertices
/// around those take the mean.
///
/// A sharp edge is no curvature: values within two cells of a crease of `mesh` stay, and so do
/// those where the second difference along an axis exceeds 0.8 spacings (a radius near one voxel),
/// so that flat faces stay flat up to their edges.
void remove_interpolation_bias(LevelSet& grid, const TriangleMesh& mesh,
                               const std::vector<Crease>& creases);

}  // namespace reckon
