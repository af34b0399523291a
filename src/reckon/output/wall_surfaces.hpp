// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reckon/boundary/wall.hpp"
#include "reckon/core/vtk_xml.hpp"

namespace reckon {

/// A box with faces along the axes.
struct Extent {
  Vec3 low;   ///< [m]
  Vec3 high;  ///< [m]
};

/// The part of a convex polygon on the side of a plane that its normal points to (Sutherland and
/// Hodgman 1974).
[[nodiscard]] std::vector<Vec3> clipped(std::span<const Vec3> polygon, const PlaneSurface& plane);

/// Walls as polygons, to be looked at.
struct WallPolygons {
  std::vector<Vec3> corners;  ///< [m]
  VtkCells polygons;
  std::vector<std::uint32_t> wall;  ///< by polygon: its place in the scene
};

/// Walls have no end; what is drawn of them ends at the other walls, and a little beyond `grains`.
/// Planes are one polygon, ledges two, cylinders a ring of them. `displacement` is one per wall,
/// since time zero; `absent` is a wall that is not there now.
[[nodiscard]] WallPolygons wall_polygons(std::span<const Wall> walls,
                                         std::span<const Vec3> displacement, const Extent& grains,
                                         std::optional<std::uint32_t> absent);

}  // namespace reckon
