// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "reckon/avatar/triangle_bvh.hpp"

namespace reckon {

/// The half space normal . x <= offset.
struct HalfSpace {
  Vec3 normal;       ///< outward, length 1
  double offset{0};  ///< [m]
};

/// The faces of the intersection of half spaces, as convex polygons that are counter-clockwise seen
/// from outside; empty when nothing is left inside. The intersection must be bounded.
[[nodiscard]] std::vector<std::vector<Vec3>> polyhedron_faces(
    const std::vector<HalfSpace>& half_spaces);

/// The radius of the largest ball inside the intersection of half spaces, to 1e-9 of itself.
[[nodiscard]] double inscribed_radius(const std::vector<HalfSpace>& half_spaces);

/// A convex polyhedron whose edges and corners are rounded with one radius: every half space is
/// moved inward by it, and what remains is blown up by a ball of that radius (an opening, in the
/// language of morphology). So the radius over that of the largest inscribed ball is its roundness
/// as Wadell (1932) defines it.
class RoundedPolyhedron {
 public:
  /// `roundness` in [0, 1). The half spaces must be bounded and hold the origin inside.
  RoundedPolyhedron(std::vector<HalfSpace> half_spaces, double roundness);

  [[nodiscard]] double corner_radius() const { return corner_radius_; }

  /// The distance from the origin to the surface along a unit vector [m].
  [[nodiscard]] double radius(const Vec3& direction) const;

 private:
  std::vector<HalfSpace> half_spaces_;
  double corner_radius_{0};
  std::optional<TriangleBvh> core_;  // what remains when moved inward; absent when sharp
};

}  // namespace reckon
