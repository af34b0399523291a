// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// The side of the least square hole that a grain passes without being turned on its way [m]: of
/// the squares around its projections along all directions the smallest. `points` are points of its
/// surface in its principal body frame, among them all corners; the search starts from the axes.
[[nodiscard]] double sieve_size(std::span<const Vec3> points);

}  // namespace reckon
