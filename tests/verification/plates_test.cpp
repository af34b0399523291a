// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// A layer of grains, endless along x and y, on a floor or between two plates. Newton's laws give
// the force on the plates, independent of the motion of grains and the borders of the cell.
#include <gtest/gtest.h>

#include <cmath>

#include "reckon/core/random.hpp"
#include "reckon/simulation/simulation.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

constexpr double edge = 9;
constexpr double lid_at = 10;

/// Sixty-four bumpy grains, moving at random.
struct Layer {
  SimulationSetup setup;
  SimulationState start;

  explicit Layer(double plate_friction) {
    const AreaLaw law{2e7, 1.5e7, area_dashpot_factor(0.6)};
    setup.shapes = testing::library_of(
        {testing::bumpy_grain(1.0, 200, 16), testing::bumpy_grain(0.8, 150, 16)});
    setup.density = 2000;
    setup.contact = {law, 0.5, MasterRule::lower_id};
    setup.walls = {{"floor", PlaneSurface{{0, 0, 0}, {0, 0, 1}}, law, plate_friction, false, {}}};
    setup.cell =
        CellSetup{.center = {1, 2, 5}, .periodic = {true, true, false}, .size = {edge, edge, 10}};
    setup.time_step = 3e-4;
    setup.skin = 0.05;
    RandomStream random{3, RandomPurpose::other, 1};
    for (std::uint32_t n = 0; n < 64; ++n) {
      GrainState grain;
      grain.id = GrainId{n};
      grain.shape = ShapeId{n % 2};
      grain.position =
          Vec3{0, 0, 1.2} + 2.25 * Vec3{n % 4 + 0.0, n / 4 % 4 + 0.0, std::floor(n / 16.0)};
      for (int axis = 0; axis < 3; ++axis) {
        grain.velocity[axis] = random.uniform(-1, 1) + (axis == 0 ? 0.7 : 0);
        grain.angular_velocity_body[axis] = random.uniform(-1, 1);
      }
      start.grains.push_back(grain);
    }
  }

  /// A lid, both plates sliding, and stages: the lid comes down, then the plates slide.
  void put_between_plates(double speed) {
    Wall& floor = setup.walls[0];
    floor.motion = WallMotion{.velocity = {-speed, 0, 0}};
    Wall lid = floor;
    lid.name = "lid";
    lid.surface = PlaneSurface{{0, 0, lid_at}, {0, 0, -1}};
    lid.motion = WallMotion{.velocity = {speed, 0, 0}};
    const double friction = floor.friction;
    setup.walls.push_back(lid);
    StageSetup press{
        .name = "press", .friction = 0.1, .wall_friction = {friction, friction}, .damping = 1};
    StageSetup shear = press;
    press.controls = {
        {.name = "lid", .walls = {WallId{1}}, .target = WallTarget::speed, .value = 3}};
    shear.name = "shear";
    shear.friction = 0.5;
    setup.stages = {press, shear};
  }
};

/// What grains above a height feel from those below [N].
Vec3 force_through(const Simulation& simulation, double height) {
  Vec3 sum;
  const auto pairs = simulation.grain_contacts().pairs();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const bool a_is_above = simulation.grains().position[pairs[p].slot_a].z > height;
    const bool b_is_above = simulation.grains().position[pairs[p].slot_b].z > height;
    if (a_is_above == b_is_above) continue;
    sum += (a_is_above ? 1.0 : -1.0) * simulation.grain_contacts().forces()[p].force_on_a;
  }
  return sum;
}

TEST(Layer, FloorAndWeightChangeTheMomentum) {
  Layer layer{0.4};
  layer.setup.body_force.gravity = {0, 0, -9.81};
  Simulation simulation{layer.setup, layer.start};
  double mass = 0;
  for (std::size_t n = 0; n < 64; ++n) mass += simulation.mass(n);
  const Vec3 weight = mass * layer.setup.body_force.gravity;
  // Momentum at a step is that of the mean of both half steps.
  const auto push = [&](const Measurement& now) { return weight - now.wall_force[0]; };
  const Measurement first = simulation.measure();
  Vec3 expected = first.momentum + 0.5 * layer.setup.time_step * push(first);
  std::uint64_t contacts = 0;
  for (int n = 0; n < 4000; ++n) {
    simulation.step();
    const Measurement now = simulation.measure();
    expected += 0.5 * layer.setup.time_step * push(now);
    ASSERT_LT(norm(now.momentum - expected), 1e-10 * norm(first.momentum)) << n;
    expected += 0.5 * layer.setup.time_step * push(now);
    contacts = std::max(contacts, now.contacts);
  }
  EXPECT_GT(contacts, 80U);
  EXPECT_LT(simulation.measure().momentum.x, 0.7 * first.momentum.x);  // friction on the floor
}

TEST(Layer, FloorCarriesTheWeightOfARestingLayer) {
  constexpr double gravity = 40;
  Layer layer{0.4};
  layer.setup.body_force.gravity = {0, 0, -gravity};
  layer.setup.damping = 8;
  Simulation simulation{layer.setup, layer.start};
  for (int n = 0; n < 12000; ++n) simulation.step();
  const Measurement now = simulation.measure();
  double weight = 0;
  double weight_above = 0;
  for (std::size_t n = 0; n < 64; ++n) {
    weight += gravity * simulation.mass(n);
    if (simulation.grains().position[n].z > 2.5) weight_above += gravity * simulation.mass(n);
  }
  EXPECT_NEAR(now.wall_force[0].z / -weight, 1, 5e-3);
  EXPECT_LT(std::hypot(now.wall_force[0].x, now.wall_force[0].y), 5e-3 * weight);
  EXPECT_NEAR(force_through(simulation, 2.5).z / weight_above, 1, 5e-3);
}

/// Means over a time of steady shearing.
struct Steady {
  Vec3 on_floor, on_lid, through_middle;  ///< [N]
};

Steady shear_between_plates(double plate_friction) {
  Layer layer{plate_friction};
  layer.put_between_plates(0.25);
  Simulation simulation{layer.setup, layer.start};
  double solids = 0;
  for (std::size_t n = 0; n < 64; ++n) solids += simulation.mass(n) / layer.setup.density;
  double height = lid_at;
  while (height > solids / (0.95 * edge * edge)) {  // so dense that both plates are pressed apart
    simulation.step();
    height = lid_at + simulation.wall_contacts().poses()[1].displacement.z;
  }
  simulation.begin_next_stage();
  Steady mean;
  constexpr int warming_up = 6000;
  constexpr int rows = 1200;
  for (int n = 0; n < warming_up; ++n) simulation.step();
  for (int row = 0; row < rows; ++row) {
    const Measurement now = simulation.measure();
    mean.on_floor += now.wall_force[0] / rows;
    mean.on_lid += now.wall_force[1] / rows;
    mean.through_middle += force_through(simulation, 0.5 * height) / rows;
    for (int n = 0; n < 10; ++n) simulation.step();
  }
  return mean;
}

TEST(Layer, RoughPlatesAndTheMiddleBearTheSameShear) {
  const Steady mean = shear_between_plates(0.5);
  const double normal = mean.on_lid.z;
  EXPECT_GT(normal, 1e4 * edge * edge);
  EXPECT_NEAR(mean.on_floor.z / -normal, 1, 0.02);
  EXPECT_NEAR(mean.through_middle.z / normal, 1, 0.02);
  // The lid slides forwards, so that grains pull it back; layers slide over each other.
  EXPECT_LT(mean.on_lid.x / normal, -0.12);
  EXPECT_NEAR(mean.on_floor.x / -mean.on_lid.x, 1, 0.05);
  EXPECT_NEAR(mean.through_middle.x / mean.on_lid.x, 1, 0.05);
}

TEST(Layer, SmoothPlatesSlideOverGrainsAtTheirOwnFriction) {
  const Steady mean = shear_between_plates(0.1);
  for (const Vec3& force : {mean.on_floor, mean.on_lid}) {
    EXPECT_LE(std::abs(force.x / force.z), 0.1 + 1e-9);
    EXPECT_GT(std::abs(force.x / force.z), 0.09);
  }
}

}  // namespace
}  // namespace reckon
