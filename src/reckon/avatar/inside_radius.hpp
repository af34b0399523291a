// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/shape/level_set.hpp"

namespace reckon {

/// A radius about the body origin beyond which the interpolated phi of a grid is nowhere negative;
/// at least `at_least`, and at most 3 % of a spacing more than needed [m].
///
/// Why it is safe: inside a box that lies in one cell, trilinear interpolation takes its extreme
/// values at the box's corners, because it is linear along every axis. So a box whose eight corner
/// values are not negative holds no point with phi < 0, and any other box holds none beyond its
/// farthest corner. Boxes that reach beyond the radius found so far are halved along each axis
/// until their size is small. Corner values within rounding of zero count as negative, and the
/// answer is rounded up.
[[nodiscard]] double inside_radius(const LevelSetView& grid, double at_least = 0);

}  // namespace reckon
