// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The near engine and the plain one end in the same bits, for any motion of the grains.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include "reckon/core/random.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/fill_region.hpp"
#include "reckon/simulation/simulation.hpp"
#include "support/same_state.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

using testing::expect_same_state;

constexpr double density = 2000;
constexpr double time_step = 3e-4;

struct Scene {
  SimulationSetup setup;
  SimulationState start;
};

std::vector<Wall> box_walls(const Vec3& low, const Vec3& high, const AnyContactLaw& law) {
  return {{"x-", PlaneSurface{low, {1, 0, 0}}, law, 0.3, false, {}},
          {"x+", PlaneSurface{high, {-1, 0, 0}}, law, 0.3, false, {}},
          {"y-", PlaneSurface{low, {0, 1, 0}}, law, 0.3, true, {}},
          {"y+", PlaneSurface{high, {0, -1, 0}}, law, 0.3, false, {}},
          {"z-", PlaneSurface{low, {0, 0, 1}}, law, 0.3, false, {}},
          {"z+", PlaneSurface{high, {0, 0, -1}}, law, 0.3, false, {}}};
}

AreaLaw area_law() { return {2e7, 1.5e7, area_dashpot_factor(0.6)}; }
LinearLaw linear_law() { return {4e5, 3e5, linear_dashpot_factor(0.6), 16}; }

SimulationSetup basic_setup(std::vector<Shape> shapes, const AnyContactLaw& law) {
  SimulationSetup setup;
  setup.shapes = testing::library_of(std::move(shapes));
  setup.density = density;
  setup.contact = {law, 0.5, MasterRule::lower_id};
  setup.body_force.gravity = {0, 0, -9.81};
  setup.time_step = time_step;
  setup.skin = 0.1;
  return setup;
}

/// Grains thrown into a box whose side wall shakes.
Scene dynamic_drop() {
  Scene scene{basic_setup({testing::bumpy_grain(1.0, 200, 16), testing::bumpy_grain(0.7, 150, 16)},
                          area_law()),
              {}};
  scene.setup.walls = box_walls({-4, -4, 0}, {4, 4, 60}, area_law());
  scene.setup.walls[0].motion =
      WallMotion{.velocity = {}, .amplitude = {0.2, 0, 0}, .frequency = 3};
  scene.setup.body_force.random_acceleration = 5;
  FillPlacement fill;
  fill.count = 50;
  fill.region = BoxConfig{{-4, -4, 0}, {4, 4, 60}};
  fill.velocity = {0.3, 0.1, -8};
  scene.start.grains = fill_region(fill, scene.setup.shapes.views(), ShapeId{0}, GrainId{0}, 4);
  return scene;
}

/// A packing that overlaps from the start, squeezed along x while it may spread along z.
Scene sheared_box(const AnyContactLaw& law) {
  Scene scene{basic_setup({testing::bumpy_grain(1.0, 279, 18), testing::sphere(0.9, 200, 18),
                           testing::box({0.6, 0.7, 0.8}, 7, 0.1)},
                          law),
              {}};
  const double pitch = 1.7;
  const double edge = 4 * pitch;
  scene.setup.walls = box_walls({0, 0, 0}, {edge, edge, edge}, law);
  scene.setup.walls[1].motion = WallMotion{.velocity = {-0.4, 0, 0}};
  scene.setup.walls[5].motion = WallMotion{.velocity = {0, 0, 0.4}};
  scene.setup.walls[3].law = AreaLaw{1e7, 1e7, area_dashpot_factor(0.3)};
  for (double friction = 0.1; Wall & wall : scene.setup.walls) wall.friction = friction += 0.05;
  scene.setup.damping = 2;
  RandomStream random{3, RandomPurpose::other, 1};
  const auto jitter = [&] { return random.uniform(-0.1, 0.1); };
  for (std::uint32_t n = 0; n < 64; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    grain.shape = ShapeId{n % 3};
    grain.position = {pitch * (n % 4 + 0.5 + jitter()), pitch * (n / 4 % 4 + 0.5 + jitter()),
                      pitch * (std::floor(n / 16.0) + 0.5 + jitter())};
    // Given with few digits, as an input file may.
    grain.orientation = {0.5, 0.5 + 0.001 * n, -0.5, 0.498};
    scene.start.grains.push_back(grain);
  }
  return scene;
}

/// A large grain in a rain of grains a tenth its size.
Scene unequal_sizes() {
  Scene scene{basic_setup({testing::bumpy_grain(5.0, 900, 40), testing::bumpy_grain(0.5, 120, 14)},
                          area_law()),
              {}};
  scene.setup.skin = 0.05;
  scene.setup.walls = box_walls({-5.5, -5.5, 0}, {5.5, 5.5, 80}, area_law());
  GrainState large;
  large.position = {0, 0, 5};
  large.angular_velocity_body = {0.3, 0.4, 0.5};
  scene.start.grains.push_back(large);
  FillPlacement fill;
  fill.count = 150;
  fill.region = BoxConfig{{-3, -3, 10.6}, {3, 3, 60}};
  fill.velocity = {0, 0, -12};
  const auto small = scene.setup.shapes.views().subspan(1, 1);
  for (GrainState grain : fill_region(fill, small, ShapeId{1}, GrainId{1}, 8)) {
    scene.start.grains.push_back(grain);
  }
  return scene;
}

/// Grains that spin so fast that their surfaces outrun their centres, and one that flies through.
Scene fast_spin() {
  Scene scene{
      basic_setup({testing::bumpy_grain(1.0, 200, 16), testing::box({0.8, 0.5, 0.6}, 6, 0.1)},
                  area_law()),
      {}};
  scene.setup.walls = box_walls({0, 0, 0}, {9, 9, 9}, area_law());
  RandomStream random{5, RandomPurpose::other, 2};
  for (std::uint32_t n = 0; n < 64; ++n) {
    GrainState grain;
    grain.id = GrainId{100 - n};
    grain.shape = ShapeId{n % 2};
    grain.position = {2.2 * (n % 4) + 1.2, 2.2 * (n / 4 % 4) + 1.2,
                      2.2 * std::floor(n / 16.0) + 1.2};
    for (int axis = 0; axis < 3; ++axis) {
      grain.angular_velocity_body[axis] = random.uniform(-80, 80);
      grain.velocity[axis] = random.uniform(-2, 2);
    }
    scene.start.grains.push_back(grain);
  }
  scene.start.grains[0].velocity = {60, 45, 30};
  return scene;
}

/// Runs both engines side by side. Returns how often the near engine skipped a pair, and so on.
ContactCounters expect_equal_engines(const Scene& scene, int steps) {
  SimulationSetup setup = scene.setup;
  setup.engine = ContactEngine::plain;
  Simulation plain{setup, scene.start};
  setup.engine = ContactEngine::near;
  Simulation near{setup, scene.start};
  for (int n = 1; n <= steps; ++n) {
    plain.step();
    near.step();
    if (n % 100 == 0 || n < 5) {
      expect_same_state(near.state(), plain.state());
      EXPECT_EQ(near.measure(), plain.measure());
      EXPECT_TRUE(
          std::ranges::equal(near.wall_contacts().forces(), plain.wall_contacts().forces()));
      if (::testing::Test::HasFatalFailure()) return {};
    }
  }
  const ContactCounters& counters = near.grain_contacts().counters();
  EXPECT_GT(counters.touching_nodes, static_cast<std::uint64_t>(steps));
  EXPECT_EQ(counters.touching_nodes, plain.grain_contacts().counters().touching_nodes);
  EXPECT_LT(counters.due, counters.pairs / 10 * 9);
  return counters;
}

TEST(Engines, AgreeOnADynamicDrop) { expect_equal_engines(dynamic_drop(), 4000); }

TEST(Engines, AgreeOnAShearedPacking) {
  expect_equal_engines(sheared_box(area_law()), 2000);
  expect_equal_engines(sheared_box(linear_law()), 2000);
}

TEST(Engines, AgreeOnUnequalSizes) { expect_equal_engines(unequal_sizes(), 2000); }

TEST(Engines, AgreeOnFastSpin) { expect_equal_engines(fast_spin(), 2000); }

TEST(Engines, AgreeWithEveryMasterRuleAndLaw) {
  for (const MasterRule master : {MasterRule::lower_id, MasterRule::smaller, MasterRule::both}) {
    for (const AnyContactLaw& law : {AnyContactLaw{area_law()}, AnyContactLaw{linear_law()},
                                     AnyContactLaw{hertz_law(1e7, 0.2, false, 0.2)}}) {
      Scene scene = sheared_box(law);
      scene.setup.contact.master = master;
      expect_equal_engines(scene, 600);
      scene = dynamic_drop();
      scene.setup.contact.master = master;
      scene.setup.contact.law = law;
      expect_equal_engines(scene, 2000);
    }
  }
}

/// With a skin wider than the scene every pair is always listed, so none can be missed. Narrow
/// skins, which depend on the speed of each grain, must end in the same bits.
TEST(Engines, AgreeWhateverTheSkin) {
  for (const Scene& scene : {dynamic_drop(), unequal_sizes(), fast_spin()}) {
    SimulationSetup setup = scene.setup;
    setup.skin = 200;
    Simulation all_pairs{setup, scene.start};
    for (int n = 0; n < 700; ++n) all_pairs.step();
    for (const double skin : {0.003, 0.1}) {
      setup.skin = skin;
      Simulation listed{setup, scene.start};
      for (int n = 0; n < 700; ++n) listed.step();
      expect_same_state(listed.state(), all_pairs.state());
      EXPECT_LT(listed.grain_contacts().counters().pairs,
                all_pairs.grain_contacts().counters().pairs / 2);
    }
  }
}

/// A grain that crosses a field of resting ones moves through its own skin, a thick one, not
/// through theirs.
TEST(Engines, OneFastGrainDoesNotEndEverybodysLists) {
  Scene scene{basic_setup({testing::sphere(1.0, 60, 12)}, area_law()), {}};
  scene.setup.body_force.gravity = {};
  for (std::uint32_t n = 0; n < 27; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    grain.position = {4.0 * (n % 3), 4.0 * (n / 3 % 3), 4.0 * std::floor(n / 9.0)};
    scene.start.grains.push_back(grain);
  }
  constexpr double motion_per_step = 0.02;
  constexpr int steps = 500;
  scene.start.grains[0].position = {2, 2, -2};
  scene.start.grains[0].velocity = {0, 0, motion_per_step / time_step};
  Simulation simulation{scene.setup, scene.start};
  for (int n = 0; n < steps; ++n) simulation.step();
  const double with_half_a_skin = steps * motion_per_step / (0.5 * scene.setup.skin);
  EXPECT_LT(static_cast<double>(simulation.list_rebuilds()), 0.3 * with_half_a_skin);
}

/// Not only results: all levels round alike, so they list the same nodes at the same steps.
TEST(Engines, AgreeOnEverySimdLevel) {
  const std::vector<SimdLevel> levels = simd_levels_here();
  RecordProperty("levels", static_cast<int>(levels.size()));
  for (const Scene& scene : {dynamic_drop(), unequal_sizes(), fast_spin()}) {
    SimulationSetup setup = scene.setup;
    setup.simd = SimdLevel::scalar;
    Simulation scalar{setup, scene.start};
    std::vector<Simulation> others;
    for (const SimdLevel level : levels) {
      setup.simd = level;
      others.emplace_back(setup, scene.start);
    }
    for (int n = 1; n <= 700; ++n) {
      scalar.step();
      for (Simulation& other : others) other.step();
    }
    for (Simulation& other : others) {
      expect_same_state(other.state(), scalar.state());
      EXPECT_EQ(other.grain_contacts().counters(), scalar.grain_contacts().counters());
    }
  }
}

/// Shapes that are kept as bands, against the whole grids that hold the same.
TEST(Engines, AgreeOnBandsAndWholeGrids) {
  for (const Scene& scene : {dynamic_drop(), sheared_box(area_law())}) {
    auto whole = std::make_shared<ShapeLibrary>();
    std::vector<ShapeOutline> outlines;
    for (const ShapeView& view : scene.setup.shapes.views()) {
      whole->push_back(view.bounding_radius > 0.8 ? testing::bumpy_grain(1.0, 279, 18)
                                                  : testing::box({0.6, 0.7, 0.8}, 7, 0.1));
      round_to_band(whole->back());
      outlines.push_back(outline_of(whole->back()));
    }
    SimulationSetup setup = scene.setup;
    setup.shapes = ShapeStore{whole};
    setup.engine = ContactEngine::plain;
    Simulation expected{setup, scene.start};
    for (int n = 0; n < 400; ++n) expected.step();
    EXPECT_GT(expected.grain_contacts().counters().touching_nodes, 400U);
    setup.shapes =
        ShapeStore{Communicator{}, outlines, [&](ShapeId s) { return (*whole)[s.get()]; }};
    for (const ContactEngine engine : {ContactEngine::plain, ContactEngine::near}) {
      setup.engine = engine;
      Simulation on_bands{setup, scene.start};
      for (int n = 0; n < 400; ++n) on_bands.step();
      expect_same_state(on_bands.state(), expected.state());
    }
    EXPECT_LT(setup.shapes.resident_bytes(), ShapeStore{whole}.resident_bytes() * 2);
  }
}

/// Only the near engine, with a restart in the middle and measurements in between, on some threads.
TEST(Engines, AgreeAcrossThreadsRestartsAndLooks) {
  const int before = thread_count();
  const auto reference = [](const Scene& scene, int steps) {
    SimulationSetup setup = scene.setup;
    setup.engine = ContactEngine::plain;
    Simulation plain{setup, scene.start};
    for (int n = 0; n < steps; ++n) plain.step();
    return plain.state();
  };
  constexpr int steps = 2000;
  for (const Scene& scene : {dynamic_drop(), sheared_box(area_law())}) {
    set_thread_count(1);
    const SimulationState expected = reference(scene, steps);
    for (const int threads : {1, 2, 4}) {
      set_thread_count(threads);
      Simulation first{scene.setup, scene.start};
      for (int n = 0; n < 777; ++n) {
        if (n % 13 == 0) static_cast<void>(first.measure());
        first.step();
      }
      Simulation second{scene.setup, first.state()};
      for (int n = 777; n < steps; ++n) {
        second.step();
        if (n % 29 == 0) static_cast<void>(second.contacts());
      }
      expect_same_state(second.state(), expected);
    }
  }
  set_thread_count(before);
}

}  // namespace
}  // namespace reckon
