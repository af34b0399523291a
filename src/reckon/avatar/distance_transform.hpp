// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/shape/level_set.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// How far from the surface transformed_distance is exact [spacings]. Beyond sqrt(3) no cell is cut
/// by the surface, so all that contact reads of a touching node is exact.
inline constexpr double exact_band = 1.75;

/// The grid that sample_signed_distance fills, without values.
[[nodiscard]] LevelSet grid_around(const BoundingBox& bounds, double spacing);

/// What sample_signed_distance computes, a hundred times faster: a closest-point transform.
///
/// - Each triangle looks at the grid's vertices around it. Within exact_band of the surface the
///   values are those of sample_signed_distance to the last bit.
/// - From there the closest points spread outwards and inwards, from vertex to vertex, nearest
///   first (after Danielsson 1980). A vertex beyond the band takes the distance to the triangle
///   that its best closest point lies on. That triangle may be a neighbour of the closest one, so
///   such values are at least the distance, and a little more where many triangles are nearly as
///   close: on spheres below 0.03 spacings more.
///
/// For `ShapeStorage::band` only what a LevelSetBand keeps is computed: values are exact within
/// band_half_width, farther outside they are that width, and deeper ones are distances to those
/// closest points themselves: below 0.2 spacings too large.
///
/// `bvh` is that of `mesh`, which must be closed.
[[nodiscard]] LevelSet transformed_distance(const TriangleMesh& mesh, const TriangleBvh& bvh,
                                            double spacing,
                                            ShapeStorage storage = ShapeStorage::full);

}  // namespace reckon
