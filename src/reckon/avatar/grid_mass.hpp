// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/shape/level_set.hpp"

namespace reckon {

/// Volume, centroid, inertia and surface area of the grain that a level set describes, by counting
/// grid vertices: each counts as a voxel, weighted by a smoothed Heaviside function of -phi, and
/// for the area by its derivative, the smoothed delta function.
///
/// A smoothed step of half width w about the surface adds to the volume the second moment of its
/// delta function times the surface's mean curvature, an error of order w^2 with one sign. The step
/// used here is H = (4 H_w - H_2w) / 3 with H_w(s) = (1 + s/w + sin(pi s/w) / pi) / 2 and w = one
/// spacing; its delta function has no second moment, so that error vanishes, and what is left for a
/// smooth grain is the sum's own error: the volume of a sphere of ten voxels diameter comes out to
/// 1e-4, where plain counting is off by a per cent. Grains with sharp edges converge with h^2.
///
/// The grid must be a signed distance within two spacings of the surface, and padded by two.
[[nodiscard]] SolidProperties grid_properties(const LevelSetView& grid);

/// Plain counting, for comparison: vertices with phi < 0, half of those with phi = 0 [m^3].
[[nodiscard]] double plain_grid_volume(const LevelSetView& grid);

}  // namespace reckon
