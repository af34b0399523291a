// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// Points on a surface with the outward normals there.
struct OrientedPoints {
  std::vector<Vec3> position;  ///< [m]
  std::vector<Vec3> normal;    ///< unit vectors

  [[nodiscard]] std::size_t size() const { return position.size(); }
};

/// `count` points that each stand for an equal share of the surface: the triangles are lined up
/// along a tree order, the line is cut into equal areas, and the place inside a triangle comes from
/// the additive recurrence of Roberts' R2 sequence. No chance is involved.
[[nodiscard]] OrientedPoints sample_surface(const TriangleMesh& mesh, std::size_t count);

/// `count` points spread evenly on a surface: Lloyd's relaxation (each point moves to the middle of
/// the samples that are nearest to it, and back onto the surface) from evenly spaced samples.
[[nodiscard]] OrientedPoints spread_points(const TriangleMesh& mesh, const TriangleBvh& bvh,
                                           std::size_t count);

/// Each point's share of a surface: the part of `samples` that is nearest to it, times `area`.
/// A sample never counts for a point whose normal is turned away from its own by more than 120
/// degrees: on a thin plate, that is a point of the other side. Sums to `area` (up to rounding).
[[nodiscard]] std::vector<double> tributary_areas(const OrientedPoints& points,
                                                  const OrientedPoints& samples, double area);

}  // namespace reckon
