// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "reckon/math/rotation.hpp"

namespace reckon {

/// Grains of a periodic cell at one moment.
struct GrainsOfCell {
  std::vector<Vec3> positions;  ///< of the images in the cell [m]
  std::vector<Vec3> shifts;     ///< from there to the unwrapped position of each grain [m]
  Mat3 edges;                   ///< of the cell, as columns [m]
};

/// Where the images that are in the cell at the start are at the end. Grains cross borders, and a
/// cell that leans far takes other edges of the same lattice, so neither the images in the cell nor
/// whole multiples of its edges can be compared. The unwrapped positions can: they show, by least
/// squares, how space deformed, and with it which whole multiples of the edges at the end those at
/// the start have become. Needs four grains or more that do not lie in a plane [m].
[[nodiscard]] std::vector<Vec3> images_later(const GrainsOfCell& start, const GrainsOfCell& end);

}  // namespace reckon
