// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// One simulation on all ranks of this mpirun against the same on one rank, bit by bit:
//   ranks_test DECOMPOSITION STEPS THREADS SIMD [pressed|bonded|membrane|cell]
// The one rank tests every node of every pair at every step. Where the machine lacks the
// instructions that SIMD names, its widest are taken. The scene is a box of grains of two sizes,
// thrown down, shaken and sheared by moving walls; `pressed` closes the box and drives its walls by
// stress and strain rate, in two stages; `bonded` cements the grains before the second; `membrane`
// presses grains in a cylinder, and then takes it for a membrane; `cell` has no walls but a
// periodic cell, pressed and then sheared. It is stopped half-way and continues from its state, as
// a restart does.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "reckon/analysis/sample.hpp"
#include "reckon/core/error.hpp"
#include "reckon/domain/decomposition_names.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/fill_region.hpp"
#include "reckon/simulation/simulation.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

SimulationSetup shaken_box(std::shared_ptr<const ShapeLibrary> shapes) {
  SimulationSetup setup;
  setup.shapes = std::move(shapes);
  setup.density = 2000;
  const AreaLaw law{2e7, 1.5e7, area_dashpot_factor(0.6)};
  setup.contact = {law, 0.5, MasterRule::both};
  const Vec3 low{-5, -5, 0};
  const Vec3 high{5, 5, 12};
  setup.walls = {
      {"x-", PlaneSurface{low, {1, 0, 0}}, law, 0.3, false,
       WallMotion{.amplitude = {0.4, 0, 0}, .frequency = 3}},
      {"x+", PlaneSurface{high, {-1, 0, 0}}, law, 0.3, false, {}},
      {"y-", PlaneSurface{low, {0, 1, 0}}, law, 0.3, false, {}},
      {"y+", PlaneSurface{high, {0, -1, 0}}, law, 0.3, false, {}},
      {"z-", PlaneSurface{low, {0, 0, 1}}, law, 0.6, false, WallMotion{.velocity = {1.5, 0, 0}}}};
  setup.body_force.gravity = {0, 0, -9.81};
  setup.body_force.random_acceleration = 5;
  setup.body_force.seed = 9;
  setup.damping = 0.1;
  setup.time_step = 3e-4;
  setup.skin = 0.1;
  return setup;
}

/// The box with a lid: the grains are pressed from all sides to 20 kPa, then along z at a steady
/// rate.
SimulationSetup pressed_box(std::shared_ptr<const ShapeLibrary> shapes) {
  SimulationSetup setup = shaken_box(std::move(shapes));
  for (Wall& wall : setup.walls) wall.motion.reset();
  setup.walls.push_back(
      {"z+", PlaneSurface{{5, 5, 28}, {0, 0, -1}}, setup.walls[0].law, 0.3, false, {}});
  for (const char* name : {"press", "shear"}) {
    StageSetup stage{
        .name = name, .friction = 0.2, .wall_friction = {0, 0, 0, 0, 0, 0}, .damping = 1};
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      stage.controls.push_back({.name = "axis",
                                .walls = {WallId{2 * axis}, WallId{2 * axis + 1}},
                                .value = 2e4,
                                .rate_limit = 4});
    }
    setup.stages.push_back(std::move(stage));
  }
  setup.stages[1].controls[2].target = WallTarget::strain_rate;
  setup.stages[1].controls[2].value = 1;
  return setup;
}

/// The pressed grains are cemented before they are sheared, and some of the cement breaks.
SimulationSetup bonded_box(std::shared_ptr<const ShapeLibrary> shapes) {
  SimulationSetup setup = pressed_box(std::move(shapes));
  setup.contact.bond = BondLaw{2e7, 1e7, 2e6, 1.5e6, 0.5};
  setup.stages[1].sets_bonds = true;
  setup.stages[1].controls[2].value = 0.2;
  return setup;
}

/// A cylinder whose lid presses the grains, then a membrane around them while the lid comes down.
SimulationSetup wrapped_cylinder(std::shared_ptr<const ShapeLibrary> shapes) {
  SimulationSetup setup = shaken_box(std::move(shapes));
  const AnyContactLaw law = setup.walls[0].law;
  setup.walls = {{"mould", CylinderSurface{{}, {0, 0, 1}, 4}, law, 0.3, false, {}},
                 {"bottom", PlaneSurface{{}, {0, 0, 1}}, law, 0.3, false, {}},
                 {"top", PlaneSurface{{0, 0, 25}, {0, 0, -1}}, law, 0.3, false, {}}};
  setup.body_force = {};
  MembraneSetup rubber;
  rubber.mould = WallId{0};
  rubber.spacing = 0.5;
  rubber.bond_stiffness = membrane_bond_stiffness(4e4);
  rubber.contact = {2e6, 2e6};
  rubber.friction = 0.4;
  rubber.damping = 20;
  rubber.areal_mass = membrane_areal_mass(rubber, 2e4, setup.time_step, 0.5);
  rubber.contact.viscosity = 0.6 * std::sqrt(2e6 * rubber.areal_mass);
  setup.membrane = rubber;
  for (const char* name : {"press", "shear"}) {
    StageSetup stage{.name = name, .friction = 0.2, .wall_friction = {0, 0, 0}, .damping = 20};
    stage.controls.push_back(
        {.name = "top", .walls = {WallId{2}}, .target = WallTarget::strain_rate, .value = 3.5});
    setup.stages.push_back(std::move(stage));
  }
  setup.stages[1].membrane = MembranePressure{2e4, 0};
  setup.stages[1].controls[0].value = 0.5;
  return setup;
}

/// A periodic cell: pressed along all axes, then sheared until it leans by more than an edge.
SimulationSetup sheared_cell(std::shared_ptr<const ShapeLibrary> shapes) {
  SimulationSetup setup = shaken_box(std::move(shapes));
  setup.walls.clear();
  setup.body_force.gravity = {};
  setup.cell = CellSetup{.center = {2, -1, 5}, .size = {9.2, 11.5, 9.2}};
  setup.skin = 0.05;
  setup.stages = {{.name = "press", .friction = 0.2, .damping = 1},
                  {.name = "shear", .friction = 0.4, .damping = 1}};
  for (const CellAxis axis : {CellAxis::x, CellAxis::y, CellAxis::z}) {
    setup.stages[0].cell_controls.push_back({.axis = axis, .value = 2e4, .rate_limit = 2});
  }
  setup.stages[1].cell_controls = {
      {.axis = CellAxis::y, .value = 2e4, .rate_limit = 2},
      {.axis = CellAxis::xy, .target = WallTarget::strain_rate, .value = 3},
      {.axis = CellAxis::xz, .target = WallTarget::strain_rate, .value = -0.5},
      {.axis = CellAxis::yz, .target = WallTarget::strain_rate, .value = 0.4}};
  return setup;
}

/// Through the cell of `sheared_cell` and, by whole edges, far out of it.
SimulationState grains_in_cell() {
  SimulationState state;
  for (std::uint32_t n = 0; n < 80; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    grain.shape = ShapeId{n % 2};
    grain.position = 2.3 * Vec3{n % 4 + 0.0, n / 4 % 5 + 0.0, std::floor(n / 20.0)};
    grain.position.x += 9.2 * (n % 7);
    grain.velocity = {0.3 * (n % 5) - 0.6, 0.4 * (n % 4) - 0.6, 0.5 * (n % 3) - 0.5};
    grain.angular_velocity_body = {0.1 * n, 2, -3};
    state.grains.push_back(grain);
  }
  return state;
}

SimulationState thrown_grains(const ShapeLibrary& shapes, bool in_cylinder) {
  FillPlacement fill;
  fill.count = 60;
  fill.region = BoxConfig{{-5, -5, 0}, {5, 5, 40}};
  if (in_cylinder) {
    fill.count = 40;
    fill.region = CylinderConfig{{}, {0, 0, 1}, 4};
    fill.region_high = 60;
  }
  fill.velocity = {0.3, 0.1, -8};
  SimulationState state;
  state.grains = fill_region(fill, testing::views_of(shapes), ShapeId{0}, GrainId{0}, 4);
  return state;
}

struct Outcome {
  SimulationState state;
  Measurement measurement;
  SampleMeasurement sample;
  std::vector<ContactRecord> contacts;
  std::uint64_t migrated{0};
};

Outcome run(const SimulationSetup& setup, SimulationState state, const Communicator& ranks,
            int steps) {
  Outcome outcome;
  for (int half = 0; half < 2; ++half) {
    if (!ranks.is_root()) state = {};
    Simulation simulation{setup, state, ranks};
    if (half == 1 && simulation.stage() != nullptr) simulation.begin_next_stage();
    for (int n = 0; n < steps / 2; ++n) {
      simulation.step();
      if (n % 100 == 0) outcome.measurement = simulation.measure();
    }
    state = simulation.state();
    outcome.measurement = simulation.measure();
    outcome.contacts = simulation.contacts();
    outcome.sample = measure_sample(simulation);
    outcome.migrated += simulation.distribution().counters().migrated_grains;
  }
  outcome.state = state;
  return outcome;
}

int compare(const Outcome& found, const Outcome& expected) {
  int failures = 0;
  const auto expect = [&failures](bool same, const char* what) {
    if (same) return;
    std::printf("differs from one rank: %s\n", what);
    ++failures;
  };
  expect(found.state.grains == expected.state.grains, "grains");
  expect(found.state.pair_springs == expected.state.pair_springs &&
             found.state.wall_springs == expected.state.wall_springs,
         "springs");
  expect(found.measurement == expected.measurement, "measurement");
  expect(found.contacts == expected.contacts, "contacts");
  expect(found.state == expected.state, "state");
  expect(found.sample == expected.sample, "sample");
  expect(expected.state.pair_springs.size() > 15, "too few contacts to tell");
  return failures;
}

SimdLevel simd_named(const std::string& name) {
  const std::vector<SimdLevel> here = simd_levels_here();
  const auto found = std::find_if(here.begin(), here.end(),
                                  [&](SimdLevel level) { return name_of(level) == name; });
  return found != here.end() ? *found : here.back();
}

int test(const Communicator& world, const std::string& decomposition, int steps,
         const std::string& simd, const std::string& scene) {
  const auto shapes =
      testing::library_of({testing::bumpy_grain(1.0, 200, 16), testing::bumpy_grain(0.7, 150, 16)});
  const bool wrapped = scene == "membrane";
  const auto make = wrapped              ? wrapped_cylinder
                    : scene == "pressed" ? pressed_box
                    : scene == "cell"    ? sheared_cell
                    : scene == "bonded"  ? bonded_box
                                         : shaken_box;
  const SimulationState start =
      scene == "cell" ? grains_in_cell() : thrown_grains(*shapes, wrapped);
  SimulationSetup setup = make(shapes);
  setup.decomposition = decomposition_named(decomposition).value();
  setup.simd = simd_named(simd);
  const Outcome found = run(setup, start, world, steps);
  std::int64_t migrated = static_cast<std::int64_t>(found.migrated);
  world.sum({&migrated, 1});
  if (!world.is_root()) return 0;
  setup = make(shapes);
  setup.engine = ContactEngine::plain;
  const Outcome expected = run(setup, start, {}, steps);
  int failures = compare(found, expected);
  if (wrapped && expected.state.membrane.springs.size() < 50) {
    std::printf("too few nodes of the membrane touch to tell\n");
    ++failures;
  }
  const Measurement& told = expected.measurement;
  if (scene == "bonded") {
    std::printf("%llu bonds hold, %llu and %llu broke in tension and shear: ",
                static_cast<unsigned long long>(told.bonds),
                static_cast<unsigned long long>(told.broken_bonds.in_tension),
                static_cast<unsigned long long>(told.broken_bonds.in_shear));
    if (told.bonds < 10 || told.broken_bonds.in_tension + told.broken_bonds.in_shear < 10)
      ++failures;
  }
  if (!scene.empty()) {
    std::printf("pressed to (%.0f, %.0f, %.0f) Pa: ", expected.sample.stress.row_x.x,
                expected.sample.stress.row_y.y, expected.sample.stress.row_z.z);
  }
  std::printf("%s, %s on %d ranks: %zu touching pairs, %lld grains migrated, %s\n",
              decomposition.c_str(), std::string{name_of(simd_named(simd))}.c_str(), world.size(),
              expected.state.pair_springs.size(), static_cast<long long>(migrated),
              failures == 0 ? "bit-identical" : "DIFFERENT");
  return failures;
}

}  // namespace
}  // namespace reckon

int main(int argc, char** argv) {
  const reckon::ParallelSession session{argc, argv};
  if (argc != 5 && argc != 6) return 2;
  reckon::set_thread_count(std::atoi(argv[3]));
  try {
    return reckon::test(session.world(), argv[1], std::atoi(argv[2]), argv[4],
                        argc == 6 ? argv[5] : "") == 0
               ? 0
               : 1;
  } catch (const reckon::Error& error) {
    std::fprintf(stderr, "rank %d: %s\n", session.world().rank(), error.what());
    session.world().abort(1);
  }
}
