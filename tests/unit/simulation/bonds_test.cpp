// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reckon/simulation/simulation.hpp"
#include "support/same_state.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

constexpr double radius = 1e-3;
constexpr double density = 2000;
constexpr double k_n = 1e12;
constexpr double k_s = 4e11;
const double bond_area = std::numbers::pi * radius * radius / 4;

/// Spheres along x whose surfaces just touch, all bonded at the start, the first held fast.
class BondedChain : public ::testing::Test {
 protected:
  void SetUp() override {
    Shape shape = testing::sphere(radius, 100);
    shape.sphere_radius = radius;
    setup_.shapes = testing::library_of({shape});
    setup_.density = density;
    setup_.contact = {AreaLaw{1e9, 1e9, 0}, 0, MasterRule::lower_id,
                      BondLaw{k_n, k_s, 1e9, 1e9, 0.5}};
    setup_.time_step = 1e-8;
    setup_.skin = 0.1 * radius;
    StageSetup cement{.name = "cement"};
    cement.sets_bonds = true;
    setup_.stages = {cement};
    mass_ = density * setup_.shapes.views()[0].mass.volume;
  }
  SimulationState chain(std::uint32_t count) const {
    SimulationState state;
    for (std::uint32_t n = 0; n < count; ++n) {
      GrainState grain;
      grain.id = GrainId{n};
      grain.prescribed = n == 0;
      grain.position = {n * (2 * radius - 1e-10), 0, 0};
      grain.orientation = normalized(Quaternion{1, 0.3 * n, 0, 0.1 * n});
      state.grains.push_back(grain);
    }
    return state;
  }

  SimulationSetup setup_;
  double mass_{0};
};

TEST_F(BondedChain, BendsAsACantileverUnderItsWeight) {
  constexpr std::uint32_t count = 4;
  const double gravity = 50;
  setup_.stages[0].gravity = {0, 0, -gravity};
  setup_.stages[0].damping = 2e4;
  setup_.time_step = 5e-8;
  Simulation beam{setup_, chain(count)};
  EXPECT_EQ(beam.measure().bonds, count - 1U);
  for (int n = 0; n < 60000; ++n) beam.step();
  ASSERT_LT(beam.measure().unbalanced_ratio, 1e-4);
  // Joint j between spheres j and j+1 carries the weights beyond it.
  const double second_moment = bond_area * radius * radius / 16;
  double tip = 0;
  for (std::uint32_t joint = 0; joint + 1 < count; ++joint) {
    double shear = 0;
    double moment = 0;
    for (std::uint32_t n = joint + 1; n < count; ++n) {
      shear += mass_ * gravity;
      moment += mass_ * gravity * (2.0 * (n - joint) - 1) * radius;
    }
    const double lever = (2.0 * (count - 1 - joint) - 1) * radius;
    tip += shear / (k_s * bond_area) + moment / (k_n * second_moment) * lever;
  }
  EXPECT_NEAR(-beam.grain_states().back().position.z, tip, 1e-3 * tip);
}

TEST_F(BondedChain, BreaksWhereItIsPulledToItsStrengthAndAccountsForTheEnergy) {
  const double strength = 2e5;
  setup_.contact.bond->tensile_strength = strength;
  SimulationState start = chain(2);
  start.grains[1].prescribed = true;
  start.grains[1].velocity = {1e-3, 0, 0};
  Simulation pair{setup_, start};
  const double opening = strength / k_n;
  const auto steps = static_cast<int>(opening / 1e-3 / setup_.time_step);
  for (int n = 0; n < steps - 1; ++n) pair.step();
  EXPECT_EQ(pair.measure().bonds, 1U);
  EXPECT_NEAR(-pair.contacts()[0].force.x, -strength * bond_area, 1e-3 * strength * bond_area);
  EXPECT_TRUE(pair.contacts()[0].bonded);
  EXPECT_EQ(pair.contacts()[0].touching, 0U);
  for (int n = 0; n < 4; ++n) pair.step();
  const Measurement broken = pair.measure();
  EXPECT_EQ(broken.bonds, 0U);
  EXPECT_EQ(broken.contacts, 0U);
  EXPECT_EQ(broken.broken_bonds, (BrokenBonds{1, 0}));
  const double released = 0.5 * bond_area * strength * strength / k_n;
  EXPECT_NEAR(broken.energy.fracture, released, 0.02 * released);
  EXPECT_NEAR(broken.energy.wall_work, released, 0.02 * released);
  EXPECT_TRUE(pair.state().pair_springs.empty());
  // It does not heal when the grains come back.
  SimulationState back = pair.state();
  back.grains[1].velocity = {-1e-3, 0, 0};
  Simulation again{setup_, back};
  for (int n = 0; n < 2 * steps; ++n) again.step();
  EXPECT_EQ(again.measure().bonds, 0U);
  EXPECT_EQ(again.measure().contacts, 1U);
  EXPECT_EQ(again.measure().broken_bonds, (BrokenBonds{1, 0}));
}

TEST_F(BondedChain, KeepsItsEnergyWhileItSwings) {
  SimulationState start = chain(5);
  start.grains[4].velocity = {0.01, 0.05, 0.02};
  start.grains[3].angular_velocity_body = {20, 0, -10};
  Simulation chain{setup_, start};
  const double before = chain.measure().energy.total();
  double turnover = 0;
  double worst = 0;
  for (int n = 1; n <= 40000; ++n) {
    chain.step();
    if (n % 100 != 0) continue;
    const EnergyBudget now = chain.measure().energy;
    turnover = std::max(turnover, now.elastic);
    worst = std::max(worst, std::abs(now.total() - before));
  }
  EXPECT_GT(turnover, 0.2 * before);
  EXPECT_LT(worst, 1e-4 * before);
}

/// Bumpy grains, bonded as they lie in a loose clump, that falls onto a plane and breaks.
class FallingClump : public ::testing::Test {
 protected:
  FallingClump() {
    const AreaLaw law{2e7, 1.5e7, area_dashpot_factor(0.6)};
    setup_.shapes = testing::library_of({testing::bumpy_grain(1.0, 200, 16)});
    setup_.density = density;
    setup_.contact = {law, 0.5, MasterRule::both, BondLaw{2e7, 1e7, 8e5, 3.5e5, 0.5}};
    setup_.walls = {{"floor", PlaneSurface{{}, {0, 0, 1}}, law, 0.3, false, {}}};
    setup_.time_step = 2e-4;
    setup_.skin = 0.1;
    StageSetup cement{.name = "cement", .friction = 0.5, .wall_friction = {0.3}};
    cement.gravity = {0, 0, -9.81};
    cement.sets_bonds = true;
    setup_.stages = {cement};
    for (std::uint32_t n = 0; n < 27; ++n) {
      GrainState grain;
      grain.id = GrainId{n};
      grain.position = {1.72 * (n % 3), 1.72 * (n / 3 % 3), 1.5 + 1.72 * std::floor(n / 9.0)};
      grain.orientation = normalized(Quaternion{1, 0.1 * n, 0.3 - 0.05 * n, 0.2});
      grain.velocity = {0.5, 0, -4};
      start_.grains.push_back(grain);
    }
  }
  SimulationState after(int steps, const SimulationState& from) const {
    Simulation simulation{setup_, from};
    for (int n = 0; n < steps; ++n) simulation.step();
    return simulation.state();
  }

  SimulationSetup setup_;
  SimulationState start_;
};

TEST_F(FallingClump, BreaksTheSameWayWhateverTheEngineTheSkinAndTheRestart) {
  const SimulationState whole = after(1500, start_);
  const auto bonded = std::count_if(whole.pair_springs.begin(), whole.pair_springs.end(),
                                    [](const PairSprings& pair) { return pair.bond.has_value(); });
  EXPECT_GT(bonded, 5);
  EXPECT_GT(whole.broken_bonds.in_tension, 2U);
  EXPECT_GT(whole.broken_bonds.in_shear, 2U);
  const auto expect_same = [&](const SimulationState& other) {
    testing::expect_same_state(other, whole);
    EXPECT_EQ(other, whole);
  };
  expect_same(after(900, after(600, start_)));
  setup_.skin = 0.6;
  expect_same(after(1500, start_));
  setup_.engine = ContactEngine::plain;
  expect_same(after(1500, start_));
}

}  // namespace
}  // namespace reckon
