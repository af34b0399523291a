// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/surface_nodes.hpp"
#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// All descriptors of the solid inside a closed surface given in its principal body frame, as
/// defined at ShapeDescriptors. `solid` holds its volume and area, `grid` its signed distance.
[[nodiscard]] ShapeDescriptors describe_shape(const TriangleMesh& body_mesh, const TriangleBvh& bvh,
                                              const SolidProperties& solid,
                                              const LevelSetView& grid);

/// The volume of the convex hull of points [m^3]. Quickhull (Barber et al. 1996) on coordinates
/// rounded to 2^-20 of the longest extent, where every orientation test is exact.
[[nodiscard]] double convex_hull_volume(std::span<const Vec3> points);

/// The radius of the largest sphere inside a closed surface [m], found by a search that starts at
/// the deepest vertex of its grid and halves its steps; to about 1e-3 of the radius.
[[nodiscard]] double inscribed_radius(const TriangleBvh& bvh, const LevelSetView& grid);

/// Wadell roundness in three dimensions: over the corners of the surface, the places where the
/// sharper of the two principal radii of curvature is below the inscribed radius, the mean of that
/// radius weighted by area, divided by the inscribed radius; 1 without corners. A place counts with
/// corner_weight, so that a face whose radius is the inscribed one, as a cylinder's side may be, is
/// no corner, and a small change of form never makes it one at once. Curvature comes from quadrics
/// fitted to the samples within `reach` of each of them, so that scale is what "corner" means:
/// radii below about half of it are not distinguished. 0 above 0.95, 1 below 0.75, linear between.
[[nodiscard]] double corner_weight(double radius_over_inscribed);
[[nodiscard]] double wadell_roundness(const OrientedPoints& samples, double inscribed,
                                      double reach);

}  // namespace reckon
