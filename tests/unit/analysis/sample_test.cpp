// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/sample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "support/test_shapes.hpp"

namespace reckon {
namespace {

constexpr double stiffness = 1e8;  // [N/m^3]

/// A cube between six walls, `half` wide to each side of the origin.
SimulationSetup cube(std::shared_ptr<const ShapeLibrary> shapes, double half) {
  const AreaLaw law{stiffness, 0.9 * stiffness, 0, 0};
  SimulationSetup setup;
  setup.shapes = std::move(shapes);
  setup.density = 2000;
  setup.contact = {law, 0.3, MasterRule::both};
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 normal;
      normal[axis] = -side;
      setup.walls.push_back({"wall", PlaneSurface{-half * normal, normal}, law, 0.3, false, {}});
    }
  }
  setup.time_step = 1e-4;
  setup.skin = 0.1;
  return setup;
}

SampleMeasurement look_at(const SimulationSetup& setup, const SimulationState& state) {
  Simulation simulation{setup, state};
  EXPECT_GT(simulation.measure().contacts, 0U);
  return measure_sample(simulation);
}

/// Eight equal spheres at the corners of a cube, all contacts with the same overlap. Their nodes
/// make the forces a little uneven.
TEST(Sample, SimpleCubicPackingIsInClosedForm) {
  const auto shapes = testing::library_of({testing::sphere(1.0, 4000)});
  const double overlap = 0.05;
  SimulationState state;
  for (std::uint32_t n = 0; n < 8; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    const auto place = [&](std::uint32_t bit) {
      return (n & bit ? 1.0 : -1.0) * (1 - overlap / 2);
    };
    grain.position = {place(1), place(2), place(4)};
    state.grains.push_back(grain);
  }
  const double half = 2 - 1.5 * overlap;  // a wall overlaps by as much as a neighbour
  const SampleMeasurement sample = look_at(cube(shapes, half), state);

  ASSERT_TRUE(sample.enclosed);
  EXPECT_NEAR(sample.volume, 8 * half * half * half, 1e-12);
  EXPECT_NEAR(sample.void_ratio, sample.volume / (8 * 4 * std::numbers::pi / 3) - 1, 1e-12);
  EXPECT_EQ(sample.coordination, 6);
  EXPECT_EQ(sample.mechanical_coordination, 6);
  EXPECT_EQ(sample.rattlers, 0U);

  // Law `area`: a cap of two spheres pushes with pi k R d^2 / 2, one on a wall with twice that,
  // through a point a third of the overlap below the sphere's surface.
  const double on_wall = std::numbers::pi * stiffness * overlap * overlap;
  EXPECT_NEAR(sample.mean_force / (0.5 * on_wall), 1, 0.05);
  const double expected =
      (4 * 0.5 * on_wall * (2 - overlap) + 8 * on_wall * (1 - overlap / 3)) / sample.volume;
  const Mat3& stress = sample.stress;
  for (const double found : {stress.row_x.x, stress.row_y.y, stress.row_z.z}) {
    EXPECT_NEAR(found / expected, 1, 0.03);
  }
  EXPECT_LT(std::abs(sample.stress.row_x.y), 0.02 * sample.stress.row_x.x);
  EXPECT_NEAR(trace(sample.branch_tensor), 1, 1e-12);
  EXPECT_NEAR(sample.branch_tensor.row_x.x, 1.0 / 3, 1e-12);
  EXPECT_LT(sample.force_variation, 0.05);
}

/// One sphere between two planes: both tensors are F over the area of the face, to the overlap.
TEST(Sample, SphereBetweenPlatensCarriesForceOverArea) {
  const auto shapes = testing::library_of({testing::sphere(1.0, 4000), testing::sphere(0.5, 200)});
  SimulationSetup setup = cube(shapes, 0.99);
  for (std::size_t w = 0; w < 4; ++w) {
    auto& plane = std::get<PlaneSurface>(setup.walls[w].surface);
    plane.point = 4 * plane.point;
  }
  SimulationState state;
  state.grains.resize(1);
  Simulation simulation{setup, state};
  const Measurement measured = simulation.measure();
  const SampleMeasurement sample = measure_sample(simulation);
  const double area = 4 * 0.99 * 2 * 4 * 0.99 * 2;
  const double wall_force = 0.5 * (measured.wall_force[5].z - measured.wall_force[4].z);
  EXPECT_GT(wall_force, 0);
  EXPECT_NEAR(sample.wall_stress.row_z.z / (wall_force / area), 1, 0.01);
  EXPECT_NEAR(sample.stress.row_z.z / (wall_force / area), 1, 0.01);
  EXPECT_LT(std::abs(sample.stress.row_x.x), 1e-3 * sample.stress.row_z.z);
  EXPECT_EQ(sample.coordination, 2);
  EXPECT_EQ(sample.contact_tensor, (Mat3{Vec3{}, Vec3{}, Vec3{}}));
}

/// One of two equal spheres lies on a wall, the other flies.
TEST(Measurement, SaysWhatIsCarriedHowDeepAndHowFast) {
  const auto shapes = testing::library_of({testing::sphere(1.0, 4000)});
  const SimulationSetup setup = cube(shapes, 5);
  SimulationState state;
  state.grains.resize(2);
  state.grains[0].position = {-4.02, 0, 0};
  state.grains[1].id = GrainId{1};
  state.grains[1].position = {2, 0, 0};
  state.grains[1].velocity = {0, 1e-3, 0};
  Simulation simulation{setup, state};
  Measurement m = simulation.measure();
  EXPECT_EQ(m.carried_share, 0.5);
  EXPECT_EQ(m.outside, 0U);
  const double volume = simulation.shapes()[0].mass.volume;
  EXPECT_NEAR(m.overlap_ratio, m.deepest_overlap / std::cbrt(6 * volume / std::numbers::pi), 1e-15);
  EXPECT_NEAR(m.overlap_ratio, 0.01, 1e-3);
  EXPECT_GT(m.energy.elastic, 0);
  const double kinetic = m.energy.translation + m.energy.rotation;
  EXPECT_NEAR(m.kinetic_ratio * m.energy.elastic / kinetic, 1, 1e-12);
  m.unbalanced_ratio = 0.001;
  m.kinetic_ratio = 0.001;
  EXPECT_TRUE(is_at_rest(m, 0.01));
  m.carried_share = 0.4;
  EXPECT_FALSE(is_at_rest(m, 0.01));

  state.grains[0].position = {-3, 0, 0};
  const Measurement flight = Simulation{setup, state}.measure();
  EXPECT_EQ(flight.carried_share, 0);
  EXPECT_EQ(flight.unbalanced_ratio, std::numeric_limits<double>::infinity());
  state.grains[0].position = {-5.1, 0, 0};
  EXPECT_EQ(Simulation(setup, state).measure().outside, 1U);
}

/// Love-Weber and wall stress differ by the grains' net forces times their places, over the volume:
/// an identity, whatever the state.
TEST(Sample, LoveWeberLessWallStressIsTheVirialOfNetForces) {
  const auto shapes = testing::library_of({testing::bumpy_grain(1.0, 400, 16)});
  const SimulationSetup setup = cube(shapes, 2.6);
  SimulationState state;
  for (std::uint32_t n = 0; n < 27; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    const auto place = [](std::uint32_t k) { return 1.65 * (static_cast<double>(k) - 1); };
    grain.position = {place(n % 3), place(n / 3 % 3), place(n / 9)};
    grain.orientation = normalized(Quaternion{1, 0.1 * n, 0.3 - 0.05 * n, 0.2});
    state.grains.push_back(grain);
  }
  Simulation simulation{setup, state};
  const auto contacts = simulation.contacts();
  const SampleMeasurement sample = measure_sample(simulation);
  ASSERT_GT(contacts.size(), 40U);
  Mat3 virial{Vec3{}, Vec3{}, Vec3{}};
  for (const ContactRecord& contact : contacts) {
    virial += outer(contact.force, state.grains[contact.grain.get()].position);
    if (contact.with_wall) continue;
    virial += outer(-contact.force, state.grains[contact.partner].position);
  }
  const auto expect_near = [&](const Vec3& love_weber, const Vec3& wall, const Vec3& rest) {
    const Vec3 error = love_weber - wall - rest / sample.volume;
    EXPECT_LT(norm(error), 1e-9 * sample.invariants.mean);
  };
  expect_near(sample.stress.row_x, sample.wall_stress.row_x, virial.row_x);
  expect_near(sample.stress.row_y, sample.wall_stress.row_y, virial.row_y);
  expect_near(sample.stress.row_z, sample.wall_stress.row_z, virial.row_z);
}

TEST(Sample, StrainAndInertialNumberFollowTheWalls) {
  const auto shapes = testing::library_of({testing::sphere(1.0, 1000)});
  SimulationSetup setup = cube(shapes, 0.995);
  setup.walls[5].motion = WallMotion{.velocity = {0, 0, -0.01}};
  SimulationState state;
  state.grains.resize(1);
  state.grains[0].prescribed = true;
  Simulation simulation{setup, state};
  for (int n = 0; n < 1000; ++n) simulation.step();
  (void)simulation.measure();
  const SampleMeasurement sample = measure_sample(simulation);
  const double height = 1.99 - 0.01 * 0.1;
  EXPECT_NEAR(sample.size.z, height, 1e-12);
  EXPECT_NEAR(sample.strain.z, std::log(1.99 / height), 1e-12);
  EXPECT_NEAR(sample.volumetric_strain, sample.strain.z, 1e-12);
  EXPECT_EQ(sample.strain.x, 0);
  const double expected = 0.01 / height * 2 * std::sqrt(2000 / sample.invariants.mean);
  EXPECT_NEAR(sample.inertial_number / expected, 1, 1e-6);
}

TEST(Sample, OpenBoxHasNoStressButItsNetwork) {
  const auto shapes = testing::library_of({testing::sphere(1.0, 1000)});
  SimulationSetup setup = cube(shapes, 3);
  setup.walls.pop_back();
  SimulationState state;
  state.grains.resize(2);
  state.grains[1].id = GrainId{1};
  state.grains[1].position = {1.95, 0, 0};
  const SampleMeasurement sample = look_at(setup, state);
  EXPECT_FALSE(sample.enclosed);
  EXPECT_EQ(sample.volume, 0);
  EXPECT_EQ(sample.coordination, 1);
  EXPECT_EQ(sample.rattlers, 2U);
  EXPECT_NEAR(sample.branch_tensor.row_x.x, 1, 1e-12);
}

}  // namespace
}  // namespace reckon
