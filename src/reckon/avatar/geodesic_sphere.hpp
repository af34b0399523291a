// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// The solid that a geodesic sphere is divided from.
enum class GeodesicBase : std::uint8_t {
  icosahedron,  ///< 20 n^2 triangles of nearly equal size
  octahedron,   ///< 8 n^2 triangles, with edges along the coordinate planes
};

/// The highest supported division; keeps meshes within 20 million triangles.
inline constexpr std::uint32_t highest_frequency = 1000;

/// The unit sphere: every face of the base is cut into n^2 triangles and its vertices are pushed
/// out to the sphere. Uses square roots only, so the bits are the same everywhere. Every vertex is
/// a direction; scaling each by a positive radius gives a star-shaped surface, which is closed and
/// cannot intersect itself. Throws Error unless 1 <= n <= highest_frequency.
[[nodiscard]] TriangleMesh geodesic_sphere(std::uint32_t n,
                                           GeodesicBase base = GeodesicBase::icosahedron);

/// The lowest division whose mean edge on a sphere of this radius is at most `target_edge`. Throws
/// Error when that takes more than highest_frequency.
[[nodiscard]] std::uint32_t geodesic_frequency(double radius, double target_edge,
                                               GeodesicBase base = GeodesicBase::icosahedron);

}  // namespace reckon
