// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "reckon/shape/shape.hpp"

namespace reckon {

// What near lists of grains and of walls share.

/// Path lengths for nodes and pairs that are always checked, or never again.
inline constexpr double check_always = -std::numeric_limits<double>::infinity();
inline constexpr double check_never = std::numeric_limits<double>::infinity();

/// A list is made anew once this share of its allowance is used up.
inline constexpr double list_lifetime = 0.75;

/// Nodes nearer than this are listed [m]: a share of their mean spacing, so that lists are as long
/// on fine shapes as on coarse ones.
[[nodiscard]] inline double list_skin(const ShapeView& shape) {
  constexpr double share_of_spacing = 0.25;
  const double count = static_cast<double>(shape.nodes.size()) + 1;
  return share_of_spacing * shape.bounding_radius * std::sqrt(4 * std::numbers::pi / count);
}

}  // namespace reckon
