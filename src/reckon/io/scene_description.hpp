// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <string_view>
#include <variant>
#include <vector>

#include "reckon/io/scene_schema.hpp"
#include "reckon/simulation/config.hpp"

/// The one description of a scene: which keys there are, what they mean, and which rules tie them
/// together. A visitor that walks it reads a scene (scene_reader.cpp), writes one
/// (scene_writer.cpp), or collects the reference (scene_schema.cpp); defaults are those of
/// simulation/config.hpp. A visitor offers
///
///   number, integer, flag, text, file, vector   one value each; where the config holds an
///                                               optional, the key may be absent without a default
///   choice         one of several words
///   table          a table that always is there, its keys described by a function
///   optional_table a table that is there or not
///   tables         an array of tables
///   one_of         exactly one (or at most one) of several keys may be given
///   rule           a condition between keys, stated for the reference and tested on reading
///   given          whether the text being read holds a key
///   visits         whether to visit a key that matters only under a condition
namespace reckon {

/// What a key is. `unit` is an SI unit that io/units understands.
struct SceneKey {
  std::string_view name;
  std::string_view unit{};
  Range range{};
  bool required{false};
  bool folder_allowed{false};    ///< for file: whether a folder will do
  std::string_view standard{};   ///< in words, where the config's default says too little
  std::string_view unit_note{};  ///< for the reference, where the unit depends on another key
  std::string_view meaning;
};

/// A word of a scene and the value it stands for.
template <class Value>
struct Choice {
  std::string_view word;
  Value value;
};
template <class Value>  // which compilers before C++20's own rule need to be told
Choice(std::string_view, Value)->Choice<Value>;

/// How many of the keys of one_of must be given.
enum class Presence { exactly_one, at_most_one };

/// Makes `variant` hold a T, keeping the one that it holds already.
template <class T, class Variant>
T& hold(Variant& variant) {
  if (!std::holds_alternative<T>(variant)) variant = T{};
  return std::get<T>(variant);
}

[[nodiscard]] inline bool below_in_every_axis(const Vec3& low, const Vec3& high) {
  return low.x < high.x && low.y < high.y && low.z < high.z;
}

template <class Visitor>
void describe(Visitor& v, MaterialConfig& material) {
  v.number({.name = "density",
            .unit = "kg/m^3",
            .range = above(0),
            .meaning = "Density of the grains' solid."},
           material.density);
  v.number({.name = "friction",
            .unit = "1",
            .range = at_least(0),
            .meaning = "Coulomb coefficient of friction between grains (not an angle)."},
           material.friction);
}

template <class Visitor>
void describe(Visitor& v, ContactConfig& contact) {
  constexpr std::array laws{Choice{"area", ContactLawKind::area},
                            Choice{"linear", ContactLawKind::linear}};
  constexpr std::array masters{Choice{"lower_id", MasterRule::lower_id},
                               Choice{"smaller", MasterRule::smaller},
                               Choice{"both", MasterRule::both}};
  v.choice({.name = "law",
            .meaning = "How a touching node pushes: `area`: stiffness times depth times the node's "
                       "area, independent of node density; `linear`: stiffness times depth per "
                       "node."},
           contact.law, laws);
  const std::string_view unit = contact.law == ContactLawKind::area ? "N/m^3" : "N/m";
  constexpr std::string_view note = "N/m^3 (law area), N/m (law linear)";
  v.number({.name = "normal_stiffness",
            .unit = unit,
            .range = above(0),
            .required = true,
            .unit_note = note,
            .meaning = "Normal stiffness of a node: per area (law `area`) or as a whole (law "
                       "`linear`)."},
           contact.normal_stiffness);
  v.number({.name = "shear_stiffness",
            .unit = unit,
            .range = above(0),
            .standard = "0.9 normal_stiffness",
            .unit_note = note,
            .meaning = "Stiffness of the shear springs, in the same measure."},
           contact.shear_stiffness);
  v.number({.name = "restitution",
            .unit = "1",
            .range = {.low = 0, .high = 1, .low_allowed = false, .high_allowed = false},
            .standard = "no dashpot",
            .meaning = "Coefficient of restitution that sets a normal dashpot in each contact."},
           contact.restitution);
  v.number({.name = "viscosity",
            .unit = "N s/m^3",
            .range = at_least(0),
            .meaning = "Law `area`: a further normal dashpot per area of touching nodes."},
           contact.viscosity);
  v.rule(contact.viscosity == 0 || contact.law == ContactLawKind::area, {"viscosity"},
         "`viscosity` belongs to law `area`; law `linear` is damped by `restitution`");
  v.integer({.name = "node_cap",
             .range = at_least(1),
             .standard = "no cap",
             .meaning = "Pairs with more touching nodes than this are scaled by cap over nodes."},
            contact.node_cap);
  v.rule(!contact.node_cap || contact.law == ContactLawKind::linear, {"node_cap"},
         "`node_cap` belongs to law `linear`; law `area` does not depend on the number of nodes");
  v.choice({.name = "master",
            .meaning = "Whose nodes are tested against whose level set: the grain with the lower "
                       "id, the one with the smaller bounding radius, or both with half weight."},
           contact.master, masters);
}

template <class Visitor>
void describe(Visitor& v, BodyForceConfig& body) {
  v.vector({.name = "gravity", .unit = "m/s^2", .meaning = "Acceleration of gravity."},
           body.gravity);
  v.number(
      {.name = "damping",
       .unit = "1/s",
       .range = at_least(0),
       .meaning = "Global damping of all motion, as a rate: velocities fall as exp(-damping t)."},
      body.damping);
  v.number({.name = "random_acceleration",
            .unit = "m/s^2",
            .range = at_least(0),
            .meaning = "Each component of a random acceleration of every grain is uniform between "
                       "minus and plus this."},
           body.random_acceleration);
  if (v.visits(body.random_acceleration > 0)) {
    v.integer({.name = "random_interval",
               .range = at_least(1),
               .unit_note = "steps",
               .meaning = "Steps between new random accelerations."},
              body.random_interval);
  }
  v.rule(!v.given("random_interval") || body.random_acceleration > 0, {"random_interval"},
         "`random_interval` needs a `random_acceleration` above zero");
  v.file({.name = "acceleration_file",
          .standard = "none",
          .meaning = "Text file with a constant acceleration `ax ay az` [m/s^2] per line, one line "
                     "per grain in the order of the scene."},
         body.acceleration_file);
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
void describe(Visitor& v, GrainsConfig& grains) {
  v.file({.name = "library",
          .required = true,
          .folder_allowed = true,
          .meaning = "Shape library, as made by `reckon grains`, or a folder of legacy LS-DEM "
                     "morphology files."},
         grains.library);
  v.number({.name = "voxel",
            .unit = "m",
            .range = above(0),
            .meaning = "Length of a voxel: the unit of legacy morphology and position files."},
           grains.voxel);
  v.one_of(Presence::exactly_one, {"fill", "place", "files"}, grains.placement.index(),
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
             } else {
               v.table({.name = "files",
                        .meaning = "Places grains from legacy LS-DEM files, shapes in turn."},
                       [&] { describe(v, hold<LegacyPlacement>(grains.placement)); });
             }
           });
}

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
  v.rule(same_name <= 1, {"name"}, "no two walls may have the same name");
  v.one_of(Presence::exactly_one, {"plane", "box", "cylinder"}, wall.geometry.index(),
           [&](std::size_t which) {
             if (which == 0) {
               v.table({.name = "plane", .meaning = "A half space for grains to stay in."},
                       [&] { describe(v, hold<PlaneConfig>(wall.geometry)); });
             } else if (which == 1) {
               v.table({.name = "box",
                        .meaning = "Six planes that look inward, named NAME.x-, NAME.x+, NAME.y- "
                                   "and so on."},
                       [&] { describe(v, hold<BoxConfig>(wall.geometry)); });
             } else {
               v.table({.name = "cylinder", .meaning = "An endless cylinder around the grains."},
                       [&] { describe(v, hold<CylinderConfig>(wall.geometry)); });
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
void describe(Visitor& v, TimeConfig& time) {
  v.one_of(Presence::at_most_one, {"step", "step_fraction"}, time.step ? 0U : 1U,
           [&](std::size_t which) {
             if (which == 0) {
               v.number({.name = "step",
                         .unit = "s",
                         .range = above(0),
                         .standard = "from step_fraction",
                         .meaning = "Time step."},
                        time.step);
             } else {
               v.number({.name = "step_fraction",
                         .unit = "1",
                         .range = {.low = 0, .high = 1, .low_allowed = false},
                         .meaning = "Time step as a fraction of sqrt(least mass / stiffness)."},
                        time.step_fraction);
             }
           });
  v.one_of(Presence::exactly_one, {"duration", "steps"}, time.duration ? 0U : 1U,
           [&](std::size_t which) {
             if (which == 0) {
               v.number({.name = "duration",
                         .unit = "s",
                         .range = above(0),
                         .standard = "from steps",
                         .meaning = "Simulated time; rounded up to whole steps."},
                        time.duration);
             } else {
               v.integer({.name = "steps",
                          .range = at_least(1),
                          .standard = "from duration",
                          .unit_note = "steps",
                          .meaning = "Number of steps."},
                         time.steps);
             }
           });
  v.number({.name = "stop_at_unbalanced_ratio",
            .unit = "1",
            .range = above(0),
            .standard = "runs to the end",
            .meaning = "Ends the run early when the unbalanced force ratio falls below this."},
           time.stop_at_unbalanced_ratio);
}

template <class Visitor>
void describe(Visitor& v, NeighborConfig& neighbor) {
  v.number({.name = "skin",
            .unit = "1",
            .range = above(0),
            .meaning = "Width of the zone in which pairs are kept listed, as a fraction of the "
                       "smallest bounding radius; changes speed, never results."},
           neighbor.skin);
}

template <class Visitor>
void describe(Visitor& v, OutputConfig& output) {
  v.integer({.name = "history_interval",
             .range = at_least(0),
             .unit_note = "steps",
             .meaning = "Steps between rows of history.csv; 0: only start and end."},
            output.history_interval);
  v.integer({.name = "fields_interval",
             .range = at_least(0),
             .unit_note = "steps",
             .meaning = "Steps between ParaView files; 0: only start and end."},
            output.fields_interval);
  v.flag({.name = "contacts", .meaning = "Writes contacts as lines beside the grains."},
         output.contacts);
  v.flag({.name = "surfaces", .meaning = "Writes the grains' true surfaces beside the grains."},
         output.surfaces);
  v.integer({.name = "checkpoint_interval",
             .range = at_least(0),
             .unit_note = "steps",
             .meaning = "Steps between checkpoints; 0: only at the end."},
            output.checkpoint_interval);
}

template <class Visitor>
void describe(Visitor& v, SceneConfig& scene) {
  v.text({.name = "title", .standard = "none", .meaning = "Says what the scene is."}, scene.title);
  v.integer({.name = "seed",
             .range = at_least(0),
             .meaning = "Keys all random numbers; one seed gives one result."},
            scene.seed);
  v.table({.name = "material", .meaning = "What grains are made of."},
          [&] { describe(v, scene.material); });
  v.table({.name = "contact", .meaning = "How touching grains push."},
          [&] { describe(v, scene.contact); });
  v.table({.name = "body", .meaning = "Forces on every grain other than contacts."},
          [&] { describe(v, scene.body); });
  v.tables({.name = "grains", .required = true, .meaning = "A set of grains; ids run on."},
           scene.grains, [&](GrainsConfig& grains) { describe(v, grains); });
  v.tables({.name = "wall", .standard = "no walls", .meaning = "A wall around the grains."},
           scene.walls, [&](WallConfig& wall) { describe(v, wall, scene); });
  v.table({.name = "time", .meaning = "How long to run."}, [&] { describe(v, scene.time); });
  v.table({.name = "neighbor", .meaning = "How neighbours are found."},
          [&] { describe(v, scene.neighbor); });
  v.table({.name = "output", .meaning = "What the run writes and how often."},
          [&] { describe(v, scene.output); });
}

}  // namespace reckon
