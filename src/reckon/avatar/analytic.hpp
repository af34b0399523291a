// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

// Solids with a closed form. Each is centred on the origin. Mesh vertices lie on the surface, so a
// mesh of a curved solid lies inside it where it bulges; volume, area and inertia converge at
// second order in the edge length. All throw Error for a length that is not positive and finite,
// and for a target_edge that would take more triangles than geodesic_sphere allows.

/// A sphere. `target_edge` is the mean edge length of the mesh [m].
[[nodiscard]] TriangleMesh sphere_mesh(double radius, double target_edge);

/// An ellipsoid with half-axes along x, y, z. `target_edge` holds along the longest.
[[nodiscard]] TriangleMesh ellipsoid_mesh(const Vec3& half_axes, double target_edge);

/// A superellipsoid (Barr 1981) with half-extents (a, b, c):
///   (|x/a|^(2/e_xy) + |y/b|^(2/e_xy))^(e_xy/e_z) + |z/c|^(2/e_z) = 1.
/// Exponent 1 is round, towards 0 boxy, 2 has flat faces that meet in edges; both lie in
/// [lowest_exponent, 2], beyond which the surface is not convex or too sharp to sample.
struct Superellipsoid {
  Vec3 half_extents;      ///< (a, b, c) [m]
  double exponent_xy{1};  ///< e_xy: the outline seen along z
  double exponent_z{1};   ///< e_z: the outline seen from the side

  static constexpr double lowest_exponent = 0.05;

  /// Where the ray from the origin along `direction` (of any length > 0) meets the surface [m].
  [[nodiscard]] Vec3 surface_point(const Vec3& direction) const;
};
[[nodiscard]] TriangleMesh superellipsoid_mesh(const Superellipsoid& solid, double target_edge);

/// A box with its faces across x, y, z. Edges and corners are kept exactly, so its volume, area and
/// inertia are exact; faces are cut into rectangles no longer than `target_edge`.
[[nodiscard]] TriangleMesh box_mesh(const Vec3& half_extents, double target_edge);

/// A cylinder along z with flat caps. The rims are kept sharp; their polygons have sides no longer
/// than `target_edge`.
[[nodiscard]] TriangleMesh cylinder_mesh(double radius, double half_height, double target_edge);

/// Exact signed distances, negative inside: callables Vec3 -> [m].
struct SphereDistance {
  double radius;
  [[nodiscard]] double operator()(const Vec3& point) const { return norm(point) - radius; }
};
struct BoxDistance {
  Vec3 half_extents;
  [[nodiscard]] double operator()(const Vec3& point) const;
};
struct CylinderDistance {
  double radius;
  double half_height;
  [[nodiscard]] double operator()(const Vec3& point) const;
};

}  // namespace reckon
