// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reckon/domain/regions.hpp"

namespace reckon::bench {

/// Where grains are and how far they reach: all that sharing them out depends on.
struct Assembly {
  std::string name;
  std::vector<Vec3> positions;  ///< [length units of the assembly]
  std::vector<double> radii;    ///< of the bounding spheres
  Region domain;                ///< what `grid` cuts: the smallest box, unless a box is given
  double skin{0};               ///< of the pair lists
  double reach{0};              ///< twice the largest radius plus the skin: the least size of a bin
};

/// `grains` grains packed evenly into a cube, with jitter, sizes that differ, and bounding spheres
/// that overlap as those of packed sand do. The largest fit into bins of size `bin`, and `grid`
/// cuts the whole cube, as in the paper's domains.
[[nodiscard]] Assembly packed_cube(std::uint32_t grains, double edge, double bin);

/// The same sand (diameters near 1) as a cone at its angle of repose, 30 degrees.
[[nodiscard]] Assembly cone_heap(std::uint32_t grains);

/// The same sand in a cube.
[[nodiscard]] Assembly dense_cube(std::uint32_t grains);

}  // namespace reckon::bench
