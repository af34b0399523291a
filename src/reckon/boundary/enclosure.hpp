// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "reckon/boundary/membrane_mesh.hpp"
#include "reckon/boundary/wall.hpp"
#include "reckon/core/id.hpp"

namespace reckon {

/// The space that walls close off, measured exactly where they stand.
struct Enclosure {
  double volume{0};  ///< [m^3]
  Vec3 low;          ///< corners of its bounding box [m]
  Vec3 high;
  std::vector<double> areas;  ///< by wall, of the part that bounds the space [m^2]

  [[nodiscard]] Vec3 size() const { return high - low; }
};

/// The space inside all planes, or inside one cylinder between planes at right angles to its axis.
/// Where there are ledges, whose tops must face each other: that of the halves below and above,
/// each inside all planes and its ledges, cut half-way between their tops. Nothing when that is not
/// bounded, is empty, or is of a form whose volume is not known exactly: a cylinder cut by oblique
/// planes, or several cylinders.
[[nodiscard]] std::optional<Enclosure> enclosure_of(std::span<const Wall> walls,
                                                    std::span<const WallPose> poses);

/// A cylinder of the scene between the planes that close it.
struct ClosedCylinder {
  CylinderPlace place;  ///< of the part between the planes
  WallId floor;         ///< at the foot
  WallId lid;
};
/// Nothing where a plane is not at right angles to the axis, or none is at an end.
[[nodiscard]] std::optional<ClosedCylinder> closed_cylinder(std::span<const Wall> walls,
                                                            std::span<const WallPose> poses,
                                                            WallId cylinder);

}  // namespace reckon
