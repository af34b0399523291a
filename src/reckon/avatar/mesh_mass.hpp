// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/math/rotation.hpp"

namespace reckon {

/// Mass properties of the solid inside a closed surface, at unit density, in the frame of the mesh.
struct SolidProperties {
  double volume{0};        ///< [m^3]; negative when the triangles face inward
  double surface_area{0};  ///< [m^2]
  Vec3 centroid;           ///< [m]
  Mat3 inertia;            ///< inertia tensor about the centroid, over density [m^5]
};

/// Exact for the polyhedron, up to rounding: the solid is the signed sum of the tetrahedra between
/// a point and each triangle. Centroid and inertia of a mesh without volume are not finite.
[[nodiscard]] SolidProperties solid_properties(const TriangleMesh& mesh);
/// Only its volume; 0 without triangles [m^3].
[[nodiscard]] double enclosed_volume(const TriangleMesh& mesh);
/// Only its surface area [m^2].
[[nodiscard]] double surface_area(const TriangleMesh& mesh);

/// Where the body frame lies in a mesh's own frame: x_body = rotation * (x_mesh - origin_mesh).
struct PrincipalFrame {
  Vec3 origin_mesh;  ///< the centroid [m]
  Mat3 rotation;     ///< mesh frame to body frame; row i is principal axis i in the mesh's frame
  Vec3 moments;      ///< principal moments over density, ascending [m^5]
};

/// Principal axes of inertia, ascending moments, right-handed.
///
/// An axis has two directions. Body x and y point so that their largest component in the mesh's
/// frame is positive (the first of equally large ones); z = x cross y. So a mesh that already lies
/// in its principal frame is not turned.
///
/// Moments that agree to `degenerate_moments` of the largest leave their axes free: then the axes
/// of the mesh's frame are kept as far as possible, unaffected by rounding.
[[nodiscard]] PrincipalFrame principal_frame(const SolidProperties& properties);

/// Relative difference below which two principal moments count as equal.
inline constexpr double degenerate_moments = 1e-9;

/// `mesh` as seen in `frame`.
[[nodiscard]] TriangleMesh to_frame(TriangleMesh mesh, const PrincipalFrame& frame);

/// `mesh` moved to its own principal frame.
[[nodiscard]] TriangleMesh to_principal_frame(TriangleMesh mesh);

}  // namespace reckon
