// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "reckon/scene/describe_geometry.hpp"
#include "reckon/scene/scene_key.hpp"
#include "reckon/simulation/config.hpp"

/// Part of the description of a scene (scene_description.hpp): walls and how they move.
namespace reckon {

template <class Visitor>
void describe(Visitor& v, WallMotion& motion) {
  v.vector({.name = "velocity", .unit = "m/s", .meaning = "Steady velocity."}, motion.velocity);
  v.vector({.name = "amplitude", .unit = "m", .meaning = "Amplitude of a sine on top of it."},
           motion.amplitude);
  v.number({.name = "frequency",
            .unit = "Hz",
            .range = at_least(0),
            .meaning = "Cycles of the sine per second."},
           motion.frequency);
  v.rule((squared_norm(motion.amplitude) > 0) == (motion.frequency > 0), {"amplitude", "frequency"},
         "`amplitude` and `frequency` go together: both above zero or neither");
  v.number({.name = "start",
            .unit = "s",
            .range = at_least(0),
            .meaning = "The wall stands still before this time."},
           motion.start);
  v.number({.name = "stop",
            .unit = "s",
            .range = above(0),
            .standard = "never",
            .meaning = "The wall stands still from this time on."},
           motion.stop);
  v.rule(!motion.stop || motion.start < *motion.stop, {"start", "stop"},
         "`start` must come before `stop`");
}

[[nodiscard]] inline bool is_plain_name(std::string_view name) {
  return !name.empty() && name.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
                              std::string_view::npos;
}

template <class Visitor>
void describe(Visitor& v, WallConfig& wall, const SceneConfig& scene) {
  v.text({.name = "name",
          .required = true,
          .meaning = "Names the wall in tables and messages: letters, digits, `_` and `-`."},
         wall.name);
  v.rule(is_plain_name(wall.name), {"name"}, "`name` must be letters, digits, `_` and `-` only");
  std::size_t same_name = 0;
  for (const WallConfig& other : scene.walls) same_name += other.name == wall.name ? 1U : 0U;
  v.rule(same_name <= 1, {"name"}, "no two walls may have the same name",
         '"' + wall.name + "\" names a wall above: write \"" + wall.name +
             std::to_string(same_name) + "\", say.");
  v.one_of(Presence::exactly_one, {"plane", "box", "cylinder", "ledge"}, wall.geometry.index(),
           [&](std::size_t which) {
             if (which == 0) {
               v.table({.name = "plane", .meaning = "A half space for grains to stay in."},
                       [&] { describe(v, hold<PlaneConfig>(wall.geometry)); });
             } else if (which == 1) {
               v.table({.name = "box",
                        .meaning = "Six planes that look inward, named NAME.x-, NAME.x+, NAME.y- "
                                   "and so on."},
                       [&] { describe(v, hold<BoxConfig>(wall.geometry)); });
             } else if (which == 2) {
               v.table({.name = "cylinder", .meaning = "An endless cylinder around the grains."},
                       [&] { describe(v, hold<CylinderConfig>(wall.geometry)); });
             } else {
               v.table({.name = "ledge",
                        .meaning = "A solid quarter of space with one straight edge: a half of a "
                                   "shear box has one on each side."},
                       [&] { describe(v, hold<LedgeConfig>(wall.geometry)); });
             }
           });
  const std::string_view unit = scene.contact.law == ContactLawKind::area ? "N/m^3" : "N/m";
  constexpr std::string_view note = "N/m^3 (law area), N/m (law linear)";
  v.number({.name = "friction",
            .unit = "1",
            .range = at_least(0),
            .standard = "material.friction",
            .meaning = "Coulomb coefficient between this wall and grains."},
           wall.friction);
  v.rule(scene.contact.law != ContactLawKind::hertz ||
             !(v.given("normal_stiffness") || v.given("shear_stiffness")),
         {"normal_stiffness", "shear_stiffness"}, "with law `hertz` walls are rigid: no stiffness",
         "Leave it out, or choose the law `area`.");
  v.number({.name = "normal_stiffness",
            .unit = unit,
            .range = above(0),
            .standard = "contact.normal_stiffness",
            .unit_note = note,
            .meaning = "Normal stiffness of a node on this wall."},
           wall.normal_stiffness);
  v.number({.name = "shear_stiffness",
            .unit = unit,
            .range = above(0),
            .standard = "contact.shear_stiffness",
            .unit_note = note,
            .meaning = "Stiffness of the shear springs on this wall."},
           wall.shear_stiffness);
  v.flag({.name = "dashpot",
          .meaning = "Whether `contact.restitution` also damps contacts with this wall."},
         wall.dashpot);
  v.flag({.name = "shortened_lever",
          .meaning = "Moments use the node's arm shortened by its depth, as in the legacy code, "
                     "instead of the arm itself."},
         wall.shortened_lever);
  v.optional_table({.name = "motion",
                    .standard = "stands still",
                    .meaning = "Moves the wall: velocity t + amplitude sin(2 pi frequency t), with "
                               "t counted from `start`."},
                   wall.motion, [&](WallMotion& motion) { describe(v, motion); });
}

template <class Visitor>
void describe(Visitor& v, OutflowConfig& outflow) {
  v.one_of(Presence::exactly_one, {"plane", "box"}, outflow.geometry.index(),
           [&](std::size_t which) {
             if (which == 0) {
               v.table({.name = "plane", .meaning = "Grains leave that are behind this plane."},
                       [&] { describe(v, hold<PlaneConfig>(outflow.geometry)); });
             } else {
               v.table({.name = "box", .meaning = "Grains leave that are outside this box."},
                       [&] { describe(v, hold<BoxConfig>(outflow.geometry)); });
             }
           });
}

}  // namespace reckon
