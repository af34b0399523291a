// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>

#include "reckon/scene/describe_membrane.hpp"
#include "reckon/scene/scene_key.hpp"
#include "reckon/simulation/config.hpp"

/// Part of the description of a scene (scene_description.hpp): the stages of a test.
namespace reckon {

template <class Visitor>
void describe(Visitor& v, ControlConfig& control) {
  v.text({.name = "wall",
          .required = true,
          .meaning = "Which planes it moves: the name of a plane, one side of a box "
                     "(`\"box.z+\"`), two that face each other and move alike (`\"box.z\"`), or "
                     "all six as three such pairs (`\"box\"`). Or a part of the periodic cell: an "
                     "edge (`\"cell.x\"`), all three (`\"cell\"`), or simple shear (`\"cell.xy\"`, "
                     "`\"cell.xz\"`, `\"cell.yz\"`: planes across the second axis slide along the "
                     "first), which takes a `strain_rate`."},
         control.wall);
  v.one_of(
      Presence::exactly_one, {"stress", "strain_rate", "speed"},
      static_cast<std::size_t>(control.target), [&](std::size_t which) {
        control.target = static_cast<WallTarget>(which);
        if (which == 0) {
          v.number(
              {.name = "stress",
               .unit = "Pa",
               .range = at_least(0),
               .meaning = "A servo holds the mean normal stress on the planes, or in the cell by "
                          "all its contacts, at this."},
              control.value);
        } else if (which == 1) {
          v.number({.name = "strain_rate",
                    .unit = "1/s",
                    .meaning = "The space between the walls, or the cell, shortens along the "
                               "planes' normal at this rate, -d(ln L)/dt; of shear, the velocity's "
                               "gradient, which may be negative."},
                   control.value);
        } else {
          v.number(
              {.name = "speed", .unit = "m/s", .meaning = "Each plane moves inward at this speed."},
              control.value);
        }
      });
  if (v.visits(control.target == WallTarget::stress)) {
    v.number({.name = "gain",
              .unit = "1",
              .range = {.low = 0, .high = 1, .low_allowed = false, .high_allowed = false},
              .meaning = "Share of the missing stress that the servo makes up for in each step."},
             control.gain);
    v.number({.name = "rate_limit",
              .unit = "1/s",
              .range = above(0),
              .standard = "inertial number 0.01 at the stress",
              .meaning = "Largest rate of strain that the servo may use."},
             control.rate_limit);
  }
  v.rule(!v.given("gain") || control.target == WallTarget::stress, {"gain"},
         "`gain` belongs to `stress`");
  v.rule(!v.given("rate_limit") || control.target == WallTarget::stress, {"rate_limit"},
         "`rate_limit` belongs to `stress`");
}

template <class Visitor>
void describe(Visitor& v, StageGoal& goal) {
  v.number({.name = "unbalanced_ratio",
            .unit = "1",
            .range = above(0),
            .standard = "not asked",
            .meaning = "The sample is at rest: the unbalanced force ratio is below this, contacts "
                       "carry half of the grains' mass at least, and the kinetic energy is below "
                       "this share of what holds the grains (`kinetic_ratio`)."},
           goal.unbalanced_ratio);
  v.number({.name = "stress_error",
            .unit = "1",
            .range = above(0),
            .standard = "not asked",
            .meaning = "Every stress that a servo holds is its target to this relative error."},
           goal.stress_error);
  if (v.visits(!goal.wall.empty())) {  // not written when absent: runs from before it go on
    v.text({.name = "wall",
            .standard = "what the stage moves by `strain_rate` or `speed`",
            .meaning = "Which planes, or which part of the cell, `strain`, `stress_above` and "
                       "`stress_below` are about, named as by a control. Needed for a stress where "
                       "several controls move something by `strain_rate` or `speed`."},
           goal.wall);
  }
  v.number({.name = "strain",
            .unit = "1",
            .range = above(0),
            .standard = "not asked",
            .meaning = "The space has become shorter or longer by this logarithmic strain since "
                       "the stage began: along `wall`, or, where it is not given and the stage "
                       "moves nothing by `strain_rate` or `speed`, along some axis. Of a cell that "
                       "is sheared, its shear strain."},
           goal.strain);
  v.number({.name = "stress_above",
            .unit = "Pa",
            .standard = "not asked",
            .meaning = "The stress on `wall` is above this; where it names several pairs of "
                       "planes, on each of them."},
           goal.stress_above);
  v.number({.name = "stress_below",
            .unit = "Pa",
            .standard = "not asked",
            .meaning = "The same stress is below this."},
           goal.stress_below);
  v.number({.name = "void_ratio",
            .unit = "1",
            .range = above(0),
            .standard = "not asked",
            .meaning = "The void ratio is not above this."},
           goal.void_ratio);
  v.number({.name = "overlap",
            .unit = "m",
            .range = above(0),
            .standard = "not asked",
            .meaning = "No node lies deeper in another grain or a wall than this, as "
                       "`deepest_overlap_m` of the history tells."},
           goal.overlap);
}

template <class Visitor>
void describe(Visitor& v, StageConfig& stage) {
  v.text({.name = "name", .required = true, .meaning = "Names the stage in messages and reports."},
         stage.name);
  v.one_of(Presence::exactly_one, {"duration", "steps"}, stage.duration ? 0U : 1U,
           [&](std::size_t which) {
             if (which == 0) {
               v.number({.name = "duration",
                         .unit = "s",
                         .range = above(0),
                         .standard = "from steps",
                         .meaning = "Simulated time after which the stage ends at the latest."},
                        stage.duration);
             } else {
               v.integer({.name = "steps",
                          .range = at_least(1),
                          .standard = "from duration",
                          .unit_note = "steps",
                          .meaning = "Number of steps after which it ends at the latest."},
                         stage.steps);
             }
           });
  v.optional_table(
      {.name = "until",
       .standard = "runs its whole time",
       .meaning = "Ends the stage early, when all conditions in it hold at once. They "
                  "are looked at with each row of the history, or every 100 steps. "
                  "Rest, stresses and overlaps, which an instant can meet by accident, "
                  "must hold at each look over five periods 2 pi sqrt(m / k) of the "
                  "grain that limits the time step; `stress_above` and `stress_below` alone "
                  "over one."},
      stage.until, [&](StageGoal& goal) { describe(v, goal); });
  v.number({.name = "friction",
            .unit = "1",
            .range = at_least(0),
            .standard = "material.friction",
            .meaning = "Coulomb coefficient between grains in this stage; a low one makes dense "
                       "samples."},
           stage.friction);
  v.number({.name = "wall_friction",
            .unit = "1",
            .range = at_least(0),
            .standard = "that of each wall",
            .meaning = "The same between grains and all walls."},
           stage.wall_friction);
  v.vector({.name = "gravity",
            .unit = "m/s^2",
            .standard = "body.gravity",
            .meaning = "Acceleration of gravity in this stage."},
           stage.gravity);
  v.number({.name = "damping",
            .unit = "1/s",
            .range = at_least(0),
            .standard = "body.damping",
            .meaning = "Global damping in this stage."},
           stage.damping);
  v.integer({.name = "history_interval",
             .range = at_least(0),
             .standard = "output.history_interval",
             .unit_note = "steps",
             .meaning = "Steps between rows of history.csv in this stage."},
            stage.history_interval);
  v.integer({.name = "fields_interval",
             .range = at_least(0),
             .standard = "output.fields_interval",
             .unit_note = "steps",
             .meaning = "Steps between ParaView files in this stage."},
            stage.fields_interval);
  v.optional_table({.name = "membrane",
                    .standard = "as in the stage before",
                    .meaning = "The pressure on the membrane, which is in place from the first "
                               "stage on that has this."},
                   stage.membrane,
                   [&](MembranePressureConfig& membrane) { describe(v, membrane); });
  if (v.visits(stage.bond)) {  // not written when off: runs from before it go on
    v.flag({.name = "bond",
            .meaning = "Sets cement, which `[bond]` describes, between all grains that touch when "
                       "the stage begins."},
           stage.bond);
  }
  v.tables({.name = "control",
            .standard = "walls stand still",
            .meaning = "Planes that move in this stage; others stand where the last stage left "
                       "them, besides a motion of their own."},
           stage.controls, [&](ControlConfig& control) { describe(v, control); });
}

}  // namespace reckon
