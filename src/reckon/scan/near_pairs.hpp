// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reckon/grains/grains.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// Two grains that touch or nearly do, and where.
struct NearPair {
  std::uint32_t a{0};  ///< places in the list of grains, a < b
  std::uint32_t b{0};
  double gap{0};      ///< least phi of one's nodes in the other's grid; negative: overlap [m]
  Vec3 point_world;   ///< that node [m]
  Vec3 normal_world;  ///< from a to b, unit length
};

/// All pairs with a gap of at most `reach` (a grid holds distances up to its padding of two
/// spacings), sorted by a, then b. Uses all threads; the result does not depend on their number.
[[nodiscard]] std::vector<NearPair> near_pairs(std::span<const ShapeView> shapes,
                                               std::span<const GrainState> grains, double reach);

/// All pairs whose surfaces come within `reach` of each other, whether or not a node lies there. It
/// starts at the node that near_pairs finds and searches the place where the larger phi is
/// smallest. Twice that is the gap between the surfaces, or minus the depth of their overlap. The
/// normal halves the angle between them. Grids hold distances up to their padding of two spacings:
/// `reach` should be less.
[[nodiscard]] std::vector<NearPair> near_surfaces(std::span<const ShapeView> shapes,
                                                  std::span<const GrainState> grains, double reach);

}  // namespace reckon
