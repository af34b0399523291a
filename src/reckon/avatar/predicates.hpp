// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/math/vec3.hpp"

namespace reckon {

// Signs of determinants of differences, exact for coordinates whose products neither overflow nor
// underflow. A floating-point evaluation decides when it is safely away from zero (Shewchuk 1997,
// "Adaptive precision floating-point arithmetic and fast robust geometric predicates"); else the
// products are expanded without rounding and added up exactly.

/// The sign of (b - a) x (c - a) . (d - a): 1 when d lies on the side of the triangle (a, b, c)
/// from which it looks counter-clockwise, -1 on the other, 0 when the four lie in one plane.
[[nodiscard]] int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Component `axis` (0, 1, 2) of (b - a) x (c - a), its sign: the turn a - b - c makes when seen
/// along that axis.
[[nodiscard]] int turn(const Vec3& a, const Vec3& b, const Vec3& c, int axis);

}  // namespace reckon
