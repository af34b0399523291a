// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reckon/core/error.hpp"
#include "reckon/simulation/simulation.hpp"
#include "support/same_state.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

using testing::expect_same_state;

/// Twenty-seven bumpy grains, loosely placed in a cube of six planes. Stages: press all three axes
/// to 20 kPa, then hold x and y and compress z.
class Cube : public ::testing::Test {
 protected:
  static constexpr double stress = 2e4;

  void SetUp() override {
    const AreaLaw law{2e7, 1.5e7, area_dashpot_factor(0.4)};
    setup_.shapes = testing::library_of({testing::bumpy_grain(1.0, 200, 16)});
    setup_.density = 2000;
    setup_.contact = {law, 0.4, MasterRule::lower_id};
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Vec3 normal;
        normal[axis] = -side;
        setup_.walls.push_back({"wall", PlaneSurface{-3.2 * normal, normal}, law, 0, false, {}});
      }
    }
    setup_.time_step = 2e-4;
    setup_.skin = 0.1;
    setup_.stages = {stage("press", 0.1), stage("shear", 0.4)};
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const std::vector<WallId> walls{WallId{2 * axis}, WallId{2 * axis + 1}};
      const WallControl hold{.name = "axis", .walls = walls, .value = stress, .rate_limit = 2};
      const WallControl squeeze{
          .name = "axis", .walls = walls, .target = WallTarget::strain_rate, .value = 0.1};
      setup_.stages[0].controls.push_back(hold);
      setup_.stages[1].controls.push_back(axis < 2 ? hold : squeeze);
    }
    for (std::uint32_t n = 0; n < 27; ++n) {
      GrainState grain;
      grain.id = GrainId{n};
      const auto place = [](std::uint32_t k) { return 2.05 * (static_cast<double>(k) - 1); };
      grain.position = {place(n % 3), place(n / 3 % 3), place(n / 9)};
      grain.orientation = normalized(Quaternion{1, 0.1 * n, 0.3 - 0.05 * n, 0.2});
      start_.grains.push_back(grain);
    }
  }
  StageSetup stage(std::string name, double friction) const {
    return {.name = std::move(name),
            .friction = friction,
            .wall_friction = std::vector<double>(setup_.walls.size(), 0.1),
            .damping = 1};
  }

  /// The stress of each axis.
  static Vec3 stresses(Simulation& simulation) {
    (void)simulation.measure();
    const auto reactions = simulation.wall_reactions();
    const auto space = enclosure_of(simulation.setup().walls, simulation.wall_contacts().poses());
    Vec3 found;
    for (int axis = 0; axis < 3; ++axis) {
      found[axis] = stress_on(simulation.setup().stages[0].controls[static_cast<std::size_t>(axis)],
                              reactions, *space);
    }
    return found;
  }

  SimulationSetup setup_;
  SimulationState start_;
};

TEST_F(Cube, ServoReachesItsStressAndKeepsItWhileSheared) {
  Simulation simulation{setup_, start_};
  for (int n = 0; n < 12000; ++n) simulation.step();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(stresses(simulation)[axis] / stress, 1, 1e-3);
  }
  simulation.begin_next_stage();
  EXPECT_EQ(simulation.stage()->name, "shear");
  double worst = 0;
  double highest = 0;
  for (int n = 0; n < 6000; ++n) {
    simulation.step();
    if (n % 100 != 0) continue;
    const Vec3 now = stresses(simulation);
    worst = std::max({worst, std::abs(now.x / stress - 1), std::abs(now.y / stress - 1)});
    highest = std::max(highest, now.z);
  }
  EXPECT_LT(worst, 0.02);
  EXPECT_GT(highest, 1.5 * stress);
}

TEST_F(Cube, RestartInAStageDoesNotChangeTheState) {
  const auto go = [&](Simulation& simulation, int from, int to) {
    for (int n = from; n < to; ++n) {
      if (n == 3000) simulation.begin_next_stage();
      simulation.step();
    }
  };
  Simulation whole{setup_, start_};
  go(whole, 0, 5000);
  for (const int cut : {1500, 3000, 4000}) {
    Simulation first{setup_, start_};
    go(first, 0, cut);
    Simulation second{setup_, first.state()};
    go(second, cut, 5000);
    expect_same_state(second.state(), whole.state());
    EXPECT_EQ(second.state(), whole.state());
  }
  EXPECT_EQ(whole.state().stage_starts, (std::vector<std::uint64_t>{0, 3000}));
  EXPECT_NE(whole.state().driven_walls[0].displacement, Vec3{});
}

TEST_F(Cube, WorkOfServoWallsBalancesTheEnergy) {
  const auto error = [&](double time_step) {
    setup_.time_step = time_step;
    Simulation simulation{setup_, start_};
    const double at_start = simulation.measure().energy.total();
    const auto steps = static_cast<int>(std::lround(1.6 / time_step));
    for (int n = 0; n < steps; ++n) simulation.step();
    simulation.begin_next_stage();
    for (int n = 0; n < steps / 4; ++n) simulation.step();
    const EnergyBudget energy = simulation.measure().energy;
    return std::abs(energy.total() - at_start) / energy.wall_work;
  };
  EXPECT_LT(error(2e-4), 0.01);
}

TEST_F(Cube, TurningGravityKeepsTheBalance) {
  setup_.stages[1].gravity = {0, 3, -9.81};
  setup_.stages[1].controls.clear();
  setup_.stages[0].controls.clear();
  for (GrainState& grain : start_.grains) grain.position.z += 0.3;
  Simulation simulation{setup_, start_};
  for (int n = 0; n < 100; ++n) simulation.step();
  const double before = simulation.measure().energy.total();
  simulation.begin_next_stage();
  const EnergyBudget after = simulation.measure().energy;
  EXPECT_GT(after.gravity, 1e5);
  EXPECT_NEAR(after.total(), before, 1e-6 * after.gravity);
}

TEST_F(Cube, PlanesThatPassEachOtherAreAnError) {
  setup_.stages[0].controls[0].target = WallTarget::speed;
  setup_.stages[0].controls[0].value = 100;
  start_.grains.resize(1);
  start_.grains[0].position = {0, 0, 100};  // nobody is inside
  Simulation simulation{setup_, start_};
  EXPECT_THROW(
      {
        for (int n = 0; n < 1000; ++n) simulation.step();
      },
      Error);
}

}  // namespace
}  // namespace reckon
