// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "reckon/scene/scene_key.hpp"
#include "reckon/simulation/config.hpp"

/// Part of the description of a scene (scene_description.hpp): forms of walls and regions.
namespace reckon {

[[nodiscard]] inline bool below_in_every_axis(const Vec3& low, const Vec3& high) {
  return low.x < high.x && low.y < high.y && low.z < high.z;
}

template <class Visitor>
void describe(Visitor& v, PlaneConfig& plane) {
  v.vector({.name = "point", .unit = "m", .required = true, .meaning = "A point of the plane."},
           plane.point);
  v.vector({.name = "normal",
            .unit = "1",
            .required = true,
            .meaning = "Points to the side on which grains are kept; any length but zero."},
           plane.normal);
  v.rule(squared_norm(plane.normal) > 0, {"normal"}, "`normal` must not be the zero vector");
}

template <class Visitor>
void describe_corners(Visitor& v, BoxConfig& box) {
  v.vector({.name = "low", .unit = "m", .required = true, .meaning = "Corner of least x, y, z."},
           box.low);
  v.vector({.name = "high", .unit = "m", .required = true, .meaning = "Corner of most x, y, z."},
           box.high);
  v.rule(below_in_every_axis(box.low, box.high), {"low", "high"},
         "`low` must be less than `high` in x, y and z");
}

template <class Visitor>
void describe(Visitor& v, BoxConfig& box) {
  describe_corners(v, box);
  v.flag({.name = "open_top", .meaning = "Leaves out the plane of most z."}, box.open_top);
}

template <class Visitor>
void describe(Visitor& v, CylinderConfig& cylinder) {
  v.vector({.name = "point", .unit = "m", .required = true, .meaning = "A point of the axis."},
           cylinder.point);
  v.vector({.name = "axis",
            .unit = "1",
            .required = true,
            .meaning = "Direction of the axis; any length but zero."},
           cylinder.axis);
  v.rule(squared_norm(cylinder.axis) > 0, {"axis"}, "`axis` must not be the zero vector");
  v.number({.name = "radius",
            .unit = "m",
            .range = above(0),
            .required = true,
            .meaning = "Inner radius."},
           cylinder.radius);
}

template <class Visitor>
void describe(Visitor& v, LedgeConfig& ledge) {
  v.vector({.name = "point", .unit = "m", .required = true, .meaning = "A point of the edge."},
           ledge.point);
  v.vector({.name = "normal",
            .unit = "1",
            .required = true,
            .meaning = "Out of the face beside the edge, to the grains; any length but zero."},
           ledge.normal);
  v.vector({.name = "top",
            .unit = "1",
            .required = true,
            .meaning = "Out of the other face, at right angles to `normal`; any length but zero."},
           ledge.top);
  const double lengths = std::sqrt(squared_norm(ledge.normal) * squared_norm(ledge.top));
  v.rule(lengths > 0 && std::abs(dot(ledge.normal, ledge.top)) <= 1e-12 * lengths,
         {"normal", "top"}, "`normal` and `top` must be at right angles, and not zero");
}

}  // namespace reckon
