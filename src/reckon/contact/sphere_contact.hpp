// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "reckon/contact/touch.hpp"
#include "reckon/grains/grain_frame.hpp"

namespace reckon {

/// Whether touches of these two need no nodes.
[[nodiscard]] inline bool are_spheres(const GrainFrame& a, const GrainFrame& b) {
  return a.shape->sphere_radius > 0 && b.shape->sphere_radius > 0;
}

/// What stands for all nodes in a cap of this overlap, if it is one, where round bodies of this
/// reduced radius touch: see touch_spheres.
inline void add_cap_touches(double overlap, double reduced_radius, const Vec3& normal,
                            const Vec3& lever, std::vector<Touch>& touches) {
  if (!(overlap > 0)) return;
  constexpr double root_of_6 = 2.449489742783178;
  constexpr std::array depths{(4 - root_of_6) / 10, (4 + root_of_6) / 10, 1.0};
  constexpr std::array shares{(16 - root_of_6) / 36, (16 + root_of_6) / 36, 1.0 / 9};
  const double area = (2 * std::numbers::pi) * reduced_radius * overlap;
  for (NodeIndex n = 0; n < depths.size(); ++n) {
    touches.push_back({n, -depths[n] * overlap, normal, lever, shares[n] * area});
  }
}

/// Two spheres. Appends what stands for all nodes of the master that touch, if any do, and returns
/// the distance between the surfaces [m].
///
/// For a small overlap d the cap of the master in the slave has the area 2 pi R* d, over which the
/// depth is spread evenly from 0 to d, with 1/R* = 1/R_a + 1/R_b. Three nodes on the line of
/// centres with the depths and weights of Radau's rule, whose last point is the whole depth d, have
/// the cap's area and its integrals of the depth up to the fourth power. So laws `area` and `hertz`
/// get the forces pi k_n R* d^2 and 4/3 E* sqrt(R*) d^(3/2) and their energies to rounding, and the
/// deepest node is as deep as the spheres overlap. The nodes are where the plane of the circle in
/// which the spheres meet cuts that line.
inline double touch_spheres(const GrainFrame& master, const GrainFrame& slave,
                            std::vector<Touch>& touches) {
  const double r = master.shape->sphere_radius;
  const double other = slave.shape->sphere_radius;
  const Vec3 apart = master.position - slave.position;
  const double distance = norm(apart);
  const double overlap = r + other - distance;
  if (!(overlap > 0) || !(distance > 0)) return -overlap;
  const Vec3 normal = apart / distance;
  const double to_plane = 0.5 * (distance + (r - other) * (r + other) / distance);
  add_cap_touches(overlap, r * other / (r + other), normal, -to_plane * normal, touches);
  return -overlap;
}

}  // namespace reckon
