// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// Four places in the list of points, in the order that makes orientation() positive.
using Tetrahedron = std::array<std::uint32_t, 4>;

/// The Delaunay tetrahedra of points in space, by insertion (Bowyer 1981, Watson 1981). They do not
/// overlap and, up to rounding, no sphere through the corners of one has a point inside; outside
/// they reach to the points' convex hull but for slivers there. The order of the points decides
/// between equals. Points that coincide with an earlier one are left out.
[[nodiscard]] std::vector<Tetrahedron> delaunay(std::span<const Vec3> points);

}  // namespace reckon
