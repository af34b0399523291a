// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/simulation.hpp"

#include <gtest/gtest.h>

#include "reckon/core/error.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/fill_region.hpp"
#include "support/same_state.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

using testing::expect_same_state;

constexpr double density = 2000;

/// A box of bumpy grains thrown down, with friction, damping, a dashpot and a shaking side wall.
SimulationSetup shaken_box(std::shared_ptr<const ShapeLibrary> shapes) {
  SimulationSetup setup;
  setup.shapes = std::move(shapes);
  setup.density = density;
  const AreaLaw law{2e7, 1.5e7, area_dashpot_factor(0.6)};
  setup.contact = {law, 0.5, MasterRule::lower_id};
  const Vec3 low{-5, -5, 0};
  const Vec3 high{5, 5, 12};
  setup.walls = {{"x-", PlaneSurface{low, {1, 0, 0}}, law, 0.3, false,
                  WallMotion{.velocity = {}, .amplitude = {0.2, 0, 0}, .frequency = 3}},
                 {"x+", PlaneSurface{high, {-1, 0, 0}}, law, 0.3, false, {}},
                 {"y-", PlaneSurface{low, {0, 1, 0}}, law, 0.3, false, {}},
                 {"y+", PlaneSurface{high, {0, -1, 0}}, law, 0.3, false, {}},
                 {"z-", PlaneSurface{low, {0, 0, 1}}, law, 0.3, false, {}}};
  setup.body_force.gravity = {0, 0, -9.81};
  setup.body_force.random_acceleration = 1;
  setup.body_force.seed = 9;
  setup.damping = 0.1;
  setup.time_step = 3e-4;
  setup.skin = 0.1;
  return setup;
}

SimulationState dropped_grains(const ShapeLibrary& shapes, std::uint32_t count) {
  FillPlacement fill;
  fill.count = count;
  fill.region = BoxConfig{{-5, -5, 0}, {5, 5, 40}};
  fill.velocity = {0.3, 0.1, -8};
  SimulationState state;
  state.grains = fill_region(fill, testing::views_of(shapes), ShapeId{0}, GrainId{0}, 4);
  return state;
}

class ShakenBox : public ::testing::Test {
 protected:
  std::shared_ptr<const ShapeLibrary> shapes_ =
      testing::library_of({testing::bumpy_grain(1.0, 200, 16), testing::bumpy_grain(0.7, 150, 16)});
  SimulationState start_ = dropped_grains(*shapes_, 60);

  SimulationState after(int steps, const SimulationSetup& setup, const SimulationState& from) {
    Simulation simulation{setup, from};
    for (int n = 0; n < steps; ++n) simulation.step();
    return simulation.state();
  }
};

TEST_F(ShakenBox, ThreadsDoNotChangeTheState) {
  const int before = thread_count();
  set_thread_count(1);
  const SimulationState one = after(2000, shaken_box(shapes_), start_);
  EXPECT_GT(one.pair_springs.size(), 15U);
  EXPECT_GT(one.wall_springs.size(), 10U);
  for (const int threads : {2, 3, 4}) {
    set_thread_count(threads);
    expect_same_state(after(2000, shaken_box(shapes_), start_), one);
  }
  set_thread_count(before);
}

TEST_F(ShakenBox, SkinAndRestartDoNotChangeTheState) {
  const SimulationState whole = after(2000, shaken_box(shapes_), start_);
  SimulationSetup other_skin = shaken_box(shapes_);
  other_skin.skin = 0.7;
  expect_same_state(after(2000, other_skin, start_), whole);
  const SimulationState half = after(1111, shaken_box(shapes_), start_);
  expect_same_state(after(889, shaken_box(shapes_), half), whole);
}

TEST_F(ShakenBox, OrderOfGrainsInMemoryDoesNotChangeTheState) {
  SimulationState reversed = start_;
  std::reverse(reversed.grains.begin(), reversed.grains.end());
  expect_same_state(after(1500, shaken_box(shapes_), reversed),
                    after(1500, shaken_box(shapes_), start_));
}

TEST_F(ShakenBox, MeasuringDoesNotDisturb) {
  Simulation watched{shaken_box(shapes_), start_};
  for (int n = 0; n < 1500; ++n) {
    if (n % 7 == 0) {
      const Measurement first = watched.measure();
      EXPECT_EQ(watched.measure(), first);
    }
    watched.step();
  }
  expect_same_state(watched.state(), after(1500, shaken_box(shapes_), start_));
}

TEST_F(ShakenBox, EnergyBalanceErrorFallsWithTheTimeStep) {
  const auto worst_error = [&](double time_step, int steps) {
    SimulationSetup setup = shaken_box(shapes_);
    setup.time_step = time_step;
    setup.body_force.random_acceleration = 0;
    Simulation simulation{setup, start_};
    const double at_start = simulation.measure().energy.total();
    double worst = 0;
    for (int n = 1; n <= steps; ++n) {
      simulation.step();
      if (n % 20 == 0) {
        worst = std::max(worst, std::abs(simulation.measure().energy.total() - at_start));
      }
    }
    const EnergyBudget end = simulation.measure().energy;
    EXPECT_GT(end.friction, 0);
    EXPECT_GT(end.dashpot, 0);
    return worst / (end.friction + end.dashpot);
  };
  const double coarse = worst_error(2e-4, 3000);
  const double fine = worst_error(5e-5, 12000);
  EXPECT_LT(coarse, 0.004);
  EXPECT_LT(fine, 0.5 * coarse);
}

TEST(Simulation, FloorCarriesTheWeight) {
  const auto shapes = testing::library_of({testing::sphere(1.0, 300)});
  SimulationSetup setup = shaken_box(shapes);
  setup.walls = {setup.walls.back()};
  setup.body_force.random_acceleration = 0;
  setup.damping = 20;
  SimulationState start;
  GrainState grain;
  grain.position = {0, 0, 1.0};
  start.grains = {grain};
  Simulation simulation{setup, start};
  for (int n = 0; n < 5000; ++n) simulation.step();
  const Measurement now = simulation.measure();
  EXPECT_NEAR(now.wall_force[0].z / (-9.81 * simulation.mass(0)), 1, 1e-3);
  EXPECT_LT(now.unbalanced_ratio, 0.02);
}

TEST(Simulation, FreePairKeepsLinearAndAngularMomentum) {
  const auto shapes = testing::library_of({testing::bumpy_grain(1.0, 400)});
  SimulationSetup setup;
  setup.shapes = shapes;
  setup.density = density;
  setup.contact = {AreaLaw{1e8, 8e7, area_dashpot_factor(0.7)}, 0.6, MasterRule::lower_id};
  setup.time_step = 1e-5;
  setup.skin = 0.1;
  SimulationState start;
  for (std::uint32_t n = 0; n < 2; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    grain.position = {n == 0 ? -1.0 : 1.0, n == 0 ? 0.0 : 0.4, 0};
    grain.velocity = {n == 0 ? 3.0 : -3.0, 0, 0.2};
    grain.angular_velocity_body = {0.5, -1, 2};
    start.grains.push_back(grain);
  }
  Simulation simulation{setup, start};
  const auto momenta = [&] {
    Vec3 linear;
    Vec3 angular;
    const Vec3& moments = (*shapes)[0].mass.inertia;
    for (std::size_t n = 0; n < 2; ++n) {
      const Grains& g = simulation.grains();
      const double m = simulation.mass(n);
      linear += m * g.velocity[n];
      // Positions and velocities half a step apart: take the position between.
      const Vec3 middle = g.position[n] - 0.5 * setup.time_step * g.velocity[n];
      angular += cross(middle, m * g.velocity[n]) +
                 rotation_matrix(g.orientation[n]) *
                     (density * hadamard(moments, g.angular_velocity_body[n]));
    }
    return std::pair{linear, angular};
  };
  const auto [linear_before, angular_before] = momenta();
  bool touched = false;
  for (int n = 0; n < 40000; ++n) {
    simulation.step();
    if (n % 500 == 0) touched = touched || simulation.measure().contacts > 0;
  }
  ASSERT_TRUE(touched);
  ASSERT_EQ(simulation.measure().contacts, 0U);  // and parted again
  const auto [linear_after, angular_after] = momenta();
  EXPECT_LT(norm(linear_after - linear_before), 1e-10 * simulation.mass(0));
  EXPECT_LT(norm(angular_after - angular_before), 1e-4 * norm(angular_before));
}

TEST(Simulation, BlowUpNamesTheGrainAndTheStep) {
  const auto shapes = testing::library_of({testing::sphere(1.0, 100)});
  SimulationSetup setup = shaken_box(shapes);
  SimulationState start;
  GrainState good;
  good.position = {0, 0, 5};
  GrainState bad = good;
  bad.id = GrainId{7};
  bad.position.x = 3;
  bad.velocity.y = std::nan("");
  start.grains = {good, bad};
  Simulation simulation{setup, start};
  try {
    simulation.step();
    FAIL() << "a NaN went unnoticed";
  } catch (const Error& error) {
    EXPECT_NE(std::string{error.what()}.find("grain 7, step 1"), std::string::npos);
  }
}

TEST(Simulation, PrescribedGrainKeepsItsCourse) {
  const auto shapes = testing::library_of({testing::sphere(1.0, 300)});
  SimulationSetup setup = shaken_box(shapes);
  setup.walls.clear();
  setup.damping = 0;
  SimulationState start;
  GrainState driven;
  driven.prescribed = true;
  driven.velocity = {1, 0, 0};
  GrainState hit;
  hit.id = GrainId{1};
  hit.position = {2.2, 0, 0};
  start.grains = {driven, hit};
  setup.body_force.gravity = {};
  setup.body_force.random_acceleration = 0;
  Simulation simulation{setup, start};
  for (int n = 0; n < 3000; ++n) simulation.step();
  EXPECT_EQ(simulation.grains().velocity[0], (Vec3{1, 0, 0}));
  EXPECT_GT(simulation.grains().velocity[1].x, 1.0);
  const EnergyBudget energy = simulation.measure().energy;
  EXPECT_GT(energy.wall_work, 0);
  EXPECT_NEAR(energy.total() / energy.translation, 0.5 * simulation.mass(0) / energy.translation,
              1e-2);
}

TEST_F(ShakenBox, GrainsBeyondAnOutflowLeaveWithTheirEnergy) {
  SimulationSetup setup = shaken_box(shapes_);
  setup.walls.pop_back();  // no floor
  setup.outflows = {{{0, 0, -6}, {0, 0, 1}}};
  Simulation simulation{setup, start_};
  const double energy = simulation.measure().energy.total();
  for (int n = 0; n < 3000; ++n) simulation.step();
  const SimulationState state = simulation.state();
  const Measurement measurement = simulation.measure();
  EXPECT_GT(state.departed.size(), 10U);
  EXPECT_EQ(state.departed.size() + state.grains.size(), 60U);
  EXPECT_EQ(measurement.departed, state.departed.size());
  for (const DepartedGrain& gone : state.departed) {
    EXPECT_LT(gone.grain.position.z, -6);
    EXPECT_GT(gone.grain.position.z, -6.1);  // at once, not when lists happen to be made anew
  }
  for (const GrainState& grain : state.grains) EXPECT_GE(grain.position.z, -6);
  EXPECT_NEAR(measurement.energy.total(), energy, 2e-3 * std::abs(measurement.energy.departed));
}

TEST(Placement, BoundingSpheresDoNotMeet) {
  const ShapeLibrary shapes{testing::sphere(1.0, 50), testing::sphere(0.5, 50)};
  FillPlacement fill;
  fill.count = 200;
  fill.region = CylinderConfig{{1, 2, 3}, {1, 1, 0}, 8};
  fill.region_low = 0;
  fill.region_high = 40;
  const auto grains = fill_region(fill, testing::views_of(shapes), ShapeId{0}, GrainId{10}, 1);
  ASSERT_EQ(grains.size(), 200U);
  const Vec3 axis = normalized(Vec3{1, 1, 0});
  for (std::size_t a = 0; a < grains.size(); ++a) {
    const Vec3 from_axis = grains[a].position - Vec3{1, 2, 3};
    EXPECT_LT(norm(from_axis - dot(from_axis, axis) * axis), 8 - 1.0);
    for (std::size_t b = a + 1; b < grains.size(); ++b) {
      EXPECT_GT(norm(grains[a].position - grains[b].position), 2.0);
    }
  }
  fill.count = 100000;
  EXPECT_THROW(
      static_cast<void>(fill_region(fill, testing::views_of(shapes), ShapeId{0}, GrainId{0}, 1)),
      Error);
}

}  // namespace
}  // namespace reckon
