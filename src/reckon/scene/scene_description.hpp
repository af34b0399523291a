// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "reckon/domain/decomposition_names.hpp"
#include "reckon/scene/describe_bond.hpp"
#include "reckon/scene/describe_cell.hpp"
#include "reckon/scene/describe_grains.hpp"
#include "reckon/scene/describe_stages.hpp"
#include "reckon/scene/describe_walls.hpp"
#include "reckon/scene/scene_key.hpp"
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

template <class Visitor>
void describe(Visitor& v, MaterialConfig& material) {
  v.number({.name = "density",
            .unit = "kg/m^3",
            .range = above(0),
            .meaning = "Density of the grains' solid."},
           material.density);
  if (v.visits(material.density_scaling != 1)) {  // not written when off: older runs go on
    v.number({.name = "density_scaling",
              .unit = "1",
              .range = at_least(1),
              .meaning = "Grains move as if they were this many times denser, but weigh what they "
                         "weigh: the time step grows with its root, for quasi-static tests alone. "
                         "Energies and inertial numbers are those of the scaled density."},
             material.density_scaling);
  }
  v.number({.name = "friction",
            .unit = "1",
            .range = at_least(0),
            .meaning = "Coulomb coefficient of friction between grains (not an angle)."},
           material.friction);
}

template <class Visitor>
void describe(Visitor& v, ContactConfig& contact) {
  constexpr std::array laws{Choice{"area", ContactLawKind::area},
                            Choice{"linear", ContactLawKind::linear},
                            Choice{"hertz", ContactLawKind::hertz}};
  constexpr std::array masters{Choice{"lower_id", MasterRule::lower_id},
                               Choice{"smaller", MasterRule::smaller},
                               Choice{"both", MasterRule::both}};
  v.choice({.name = "law",
            .meaning = "How a touching node pushes: `area`: stiffness times depth times the node's "
                       "area, independent of node density; `linear`: stiffness times depth per "
                       "node; `hertz`: Hertz and Mindlin's law from elastic constants."},
           contact.law, laws);
  const std::string_view unit = contact.law == ContactLawKind::area ? "N/m^3" : "N/m";
  constexpr std::string_view note = "N/m^3 (law area), N/m (law linear)";
  const bool is_hertz = contact.law == ContactLawKind::hertz;
  v.rule(!is_hertz || !(v.given("normal_stiffness") || v.given("shear_stiffness")),
         {"normal_stiffness", "shear_stiffness"},
         "law `hertz` takes no stiffness but `young_modulus` and `poisson_ratio`",
         "Write `young_modulus = \"70 GPa\"` and `poisson_ratio = 0.25`, say, instead of it; or "
         "choose "
         "the law `area`.");
  if (v.visits(!is_hertz)) {
    v.number({.name = "normal_stiffness",
              .unit = unit,
              .range = above(0),
              .required = !is_hertz,
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
  }
  if (v.visits(is_hertz)) {
    v.number({.name = "young_modulus",
              .unit = "Pa",
              .range = above(0),
              .required = is_hertz,
              .standard = is_hertz ? "" : "needed by law hertz",
              .meaning = "Law `hertz`: Young's modulus of the grains; walls are rigid."},
             contact.young_modulus);
    v.number({.name = "poisson_ratio",
              .unit = "1",
              .range = {.low = 0, .high = 0.5},
              .meaning = "Law `hertz`: Poisson's ratio of the grains."},
             contact.poisson_ratio);
  }
  v.rule(is_hertz || !(v.given("young_modulus") || v.given("poisson_ratio")),
         {"young_modulus", "poisson_ratio"},
         "`young_modulus` and `poisson_ratio` belong to law `hertz`",
         "Write `law = \"hertz\"`, or give `normal_stiffness` instead.");
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
             .meaning = "Pairs of grains with more touching nodes than this are scaled by cap over "
                        "nodes; walls are not."},
            contact.node_cap);
  v.rule(!contact.node_cap || contact.law == ContactLawKind::linear, {"node_cap"},
         "`node_cap` belongs to law `linear`; law `area` does not depend on the number of nodes");
  v.choice({.name = "master",
            .meaning = "Whose nodes are tested against whose level set: those of both grains, each "
                       "node with the same area on average (half weight where the grains are "
                       "alike); of the grain with the lower id (the paper's rule: the answer "
                       "depends on the order of the grains); or of the grain with the smaller "
                       "bounding radius."},
           contact.master, masters);
  if (v.visits(contact.allow_inside)) {  // not written when off: older runs go on
    v.flag({.name = "allow_inside",
            .meaning = "Lets a run begin although the centre of a grain lies inside another grain "
                       "or beyond a wall, to let contacts push them apart. Without it such a scene "
                       "is refused, since contacts are found at surfaces only."},
           contact.allow_inside);
  }
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
void describe(Visitor& v, TimeConfig& time, bool stages) {
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
  v.one_of(stages ? Presence::at_most_one : Presence::exactly_one, {"duration", "steps"},
           time.duration ? 0U : 1U, [&](std::size_t which) {
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
  v.rule(
      !stages || !(v.given("duration") || v.given("steps") || v.given("stop_at_unbalanced_ratio")),
      {"duration", "steps", "stop_at_unbalanced_ratio"},
      "with [[stage]] tables, only they say when to end: no `duration`, `steps` or "
      "`stop_at_unbalanced_ratio` here");
}

template <class Visitor>
void describe(Visitor& v, NeighborConfig& neighbor) {
  v.number({.name = "skin",
            .unit = "1",
            .range = above(0),
            .meaning = "Width of the zone in which pairs are kept listed, as a fraction of the "
                       "smallest bounding radius; changes speed, never results."},
           neighbor.skin);
  constexpr std::array engines{Choice{"near", ContactEngine::near},
                               Choice{"plain", ContactEngine::plain}};
  v.choice({.name = "engine",
            .meaning = "How touching nodes are found: `near` remembers which nodes are near a "
                       "partner and for how long they cannot touch; `plain` tests every node at "
                       "every step, many times slower. Both give the same results."},
           neighbor.engine, engines);
  constexpr std::array levels{Choice{"auto", SimdLevel::automatic},
                              Choice{"scalar", SimdLevel::scalar}, Choice{"avx2", SimdLevel::avx2},
                              Choice{"avx512", SimdLevel::avx512}, Choice{"neon", SimdLevel::neon}};
  v.choice({.name = "simd",
            .meaning = "Instructions that look for near nodes: `auto` takes the widest that the "
                       "machine has. All give the same results."},
           neighbor.simd, levels);
}

template <class Visitor>
void describe(Visitor& v, ParallelConfig& parallel) {
  constexpr auto decompositions = choices_of(decomposition_names);
  v.choice(
      {.name = "decomposition",
       .meaning = "How ranks share the grains: `balanced`: regions of equal work by recursive "
                  "bisection, for any arrangement; `grid`: the equal blocks of Tan and Sitar "
                  "(2024); `bins`: `grid` with the naive walk over all bins; `replicated`: every "
                  "rank sees all grains and tests all pairs. The last two are slow references. "
                  "All give the same results."},
      parallel.decomposition, decompositions);
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
  if (v.visits(output.sample)) {  // not written when off: runs from before it go on
    v.flag(
        {.name = "sample",
         .meaning = "Adds columns to history.csv for stress, strain, void ratio, fabric and forces "
                    "of the sample between the walls."},
        output.sample);
  }
  v.flag({.name = "contacts", .meaning = "Writes contacts as lines beside the grains."},
         output.contacts);
  v.flag({.name = "surfaces", .meaning = "Writes the grains' true surfaces beside the grains."},
         output.surfaces);
  if (v.visits(output.ranks)) {  // as sample
    v.flag({.name = "ranks",
            .meaning = "Writes which rank has each grain, beside the grains: all else in a run's "
                       "files is the same for any number of ranks."},
           output.ranks);
  }
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
  v.table({.name = "material", .meaning = "What all grains are made of: one material."},
          [&] { describe(v, scene.material); });
  v.table({.name = "contact", .meaning = "How touching grains push."},
          [&] { describe(v, scene.contact); });
  v.optional_table({.name = "bond",
                    .standard = "none",
                    .meaning = "Cement that joins grains, beside the law of their contact, from "
                               "the beginning of a stage with `bond = true` until it breaks."},
                   scene.bond, [&](BondConfig& bond) { describe(v, bond, scene.contact); });
  v.table({.name = "body", .meaning = "Forces on every grain other than contacts."},
          [&] { describe(v, scene.body); });
  v.tables({.name = "grains", .required = true, .meaning = "A set of grains; ids run on."},
           scene.grains, [&](GrainsConfig& grains) { describe(v, grains); });
  v.tables({.name = "wall", .standard = "no walls", .meaning = "A wall around the grains."},
           scene.walls, [&](WallConfig& wall) { describe(v, wall, scene); });
  v.optional_table({.name = "membrane",
                    .standard = "none",
                    .meaning = "A flexible sheet around a cylindrical sample, under pressure from "
                               "outside."},
                   scene.membrane, [&](MembraneConfig& membrane) { describe(v, membrane); });
  v.optional_table({.name = "cell",
                    .standard = "none",
                    .meaning = "A periodic cell: what leaves it on one side comes in on the other. "
                               "A stage's controls deform it."},
                   scene.cell, [&](CellConfig& cell) { describe(v, cell); });
  v.tables({.name = "outflow",
            .standard = "grains stay",
            .meaning = "Grains whose centre gets beyond it are taken out of the simulation; "
                       "history.csv counts them. Without one no grain is ever removed."},
           scene.outflows, [&](OutflowConfig& outflow) { describe(v, outflow); });
  v.tables({.name = "stage",
            .standard = "none: one run for the length in [time]",
            .meaning = "A stage of a test. Stages run one after another; the run ends with the "
                       "last."},
           scene.stages, [&](StageConfig& stage) { describe(v, stage); });
  v.table({.name = "time", .meaning = "How long to run."},
          [&] { describe(v, scene.time, !scene.stages.empty()); });
  v.table({.name = "neighbor", .meaning = "How neighbours are found."},
          [&] { describe(v, scene.neighbor); });
  v.table({.name = "parallel",
           .meaning = "How several processes (`mpirun -np N reckon run ...`) share the work."},
          [&] { describe(v, scene.parallel); });
  v.table({.name = "output", .meaning = "What the run writes and how often."},
          [&] { describe(v, scene.output); });
}

}  // namespace reckon
