// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "reckon/scene/describe_geometry.hpp"
#include "reckon/scene/scene_key.hpp"
#include "reckon/simulation/config.hpp"

/// Part of the description of a scene (scene_description.hpp): where grains come from.
namespace reckon {

template <class Visitor>
void describe(Visitor& v, FillPlacement& fill) {
  v.integer({.name = "count",
             .range = {.low = 1, .high = 1e8},
             .required = true,
             .meaning = "How many grains to place."},
            fill.count);
  v.one_of(Presence::exactly_one, {"box", "cylinder"}, fill.region.index(), [&](std::size_t which) {
    if (which == 0) {
      v.table({.name = "box", .meaning = "Fills the box between two corners."},
              [&] { describe_corners(v, hold<BoxConfig>(fill.region)); });
    } else {
      v.table({.name = "cylinder", .meaning = "Fills a piece of a cylinder."}, [&] {
        describe(v, hold<CylinderConfig>(fill.region));
        v.number({.name = "low",
                  .unit = "m",
                  .required = true,
                  .meaning = "Where the piece begins, along the axis from `point`."},
                 fill.region_low);
        v.number({.name = "high",
                  .unit = "m",
                  .required = true,
                  .meaning = "Where the piece ends, along the axis from `point`."},
                 fill.region_high);
        v.rule(fill.region_low < fill.region_high, {"low", "high"},
               "`low` must be less than `high`");
      });
    }
  });
  v.vector({.name = "velocity", .unit = "m/s", .meaning = "Initial velocity of every grain."},
           fill.velocity);
}

/// A rotation by axis and angle, kept as the quaternion (w, x, y, z).
template <class Visitor>
void describe_rotation(Visitor& v, std::vector<double>& quaternion) {
  Vec3 axis{0, 0, 1};
  double angle = 0;
  v.vector({.name = "axis",
            .unit = "1",
            .required = true,
            .meaning = "Axis of the turn in the world frame; any length but zero."},
           axis);
  v.rule(squared_norm(axis) > 0, {"axis"}, "`axis` must not be the zero vector");
  v.number({.name = "angle",
            .unit = "rad",
            .required = true,
            .meaning = "Right-handed angle of the turn, e.g. \"30 deg\"."},
           angle);
  const Vec3 half = std::sin(0.5 * angle) * normalized(axis);
  quaternion = {std::cos(0.5 * angle), half.x, half.y, half.z};
}

template <class Visitor>
void describe(Visitor& v, ExplicitGrain& grain) {
  v.text({.name = "shape",
          .standard = "the library's shapes in turn",
          .meaning = "Name of the shape in the library."},
         grain.shape);
  v.vector({.name = "position",
            .unit = "m",
            .required = true,
            .meaning = "Place of the centre of mass."},
           grain.position);
  v.one_of(Presence::at_most_one, {"orientation", "rotation"}, 0U, [&](std::size_t which) {
    if (which == 0) {
      v.quaternion({.name = "orientation",
                    .unit = "1",
                    .meaning = "Quaternion (w, x, y, z) that turns the body frame into the world "
                               "frame; any length but zero."},
                   grain.orientation);
    } else {
      v.table({.name = "rotation",
               .standard = "see orientation",
               .meaning = "The same as a turn about an axis."},
              [&] { describe_rotation(v, grain.orientation); });
    }
  });
  v.vector({.name = "velocity", .unit = "m/s", .meaning = "Initial velocity."}, grain.velocity);
  v.vector({.name = "angular_velocity",
            .unit = "rad/s",
            .meaning = "Initial angular velocity in the world frame."},
           grain.angular_velocity);
  v.flag(
      {.name = "fixed",
       .meaning = "The grain keeps its velocities whatever the forces: it stands still when they "
                  "are zero."},
      grain.fixed);
}

template <class Visitor>
void describe(Visitor& v, LegacyPlacement& files) {
  v.file({.name = "positions",
          .required = true,
          .meaning = "Text file, a line `x y z` per grain, in voxels."},
         files.positions_file);
  v.file({.name = "rotations",
          .required = true,
          .meaning = "Text file, a line `a b c d` per grain: the quaternion (w, x, y, z) = (d, -b, "
                     "a, -c)."},
         files.rotations_file);
}

template <class Visitor>
void describe(Visitor& v, TablePlacement& table) {
  v.file(
      {.name = "file",
       .required = true,
       .meaning = "Text file, a line `shape, x, y, z, qw, qx, qy, qz` per grain: the shape's place "
                  "in the library from 0, the centre of mass [m], the quaternion that turns the "
                  "body frame into the world frame; `reckon grains scan` and `from-scan` write "
                  "such tables."},
      table.file);
}

template <class Visitor>
void describe(Visitor& v, GrainsConfig& grains) {
  v.file({.name = "library",
          .required = true,
          .folder_allowed = true,
          .meaning = "Shape library, as made by `reckon grains`, or a folder of legacy LS-DEM "
                     "morphology files."},
         grains.library);
  v.number({.name = "voxel",
            .unit = "m",
            .range = {.low = 1e-30, .high = 1e30},
            .meaning = "Length of a voxel: the unit of legacy morphology and position files."},
           grains.voxel);
  v.one_of(Presence::exactly_one, {"fill", "place", "files", "table"}, grains.placement.index(),
           [&](std::size_t which) {
             if (which == 0) {
               v.table(
                   {.name = "fill",
                    .meaning = "Places grains drawn from the library in random orientations, from "
                               "below, without overlap of bounding spheres."},
                   [&] { describe(v, hold<FillPlacement>(grains.placement)); });
             } else if (which == 1) {
               v.tables({.name = "place", .meaning = "Places one grain each."},
                        hold<std::vector<ExplicitGrain>>(grains.placement),
                        [&](ExplicitGrain& grain) { describe(v, grain); });
             } else if (which == 2) {
               v.table({.name = "files",
                        .meaning = "Places grains from legacy LS-DEM files, shapes in turn."},
                       [&] { describe(v, hold<LegacyPlacement>(grains.placement)); });
             } else {
               v.table({.name = "table", .meaning = "Places grains as a table of poses says."},
                       [&] { describe(v, hold<TablePlacement>(grains.placement)); });
             }
           });
}

}  // namespace reckon
