// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// Sliding, sticking and rolling against closed forms.
#include <gtest/gtest.h>

#include "support/verification_table.hpp"
#include "verification/one_grain_on_plane.hpp"

namespace reckon {
namespace {

using testing::OneGrainOnPlane;
using testing::run_until;

constexpr double g = 9.81;

Vec3 leaning_gravity(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {g * std::sin(angle), 0, -g * std::cos(angle)};
}

/// Acceleration of a flat block along an inclined floor with friction 0.5, once it has settled.
double block_acceleration(double degrees) {
  OneGrainOnPlane scene;
  scene.law = {1e7, 1e7, 0.5};
  scene.gravity = leaning_gravity(degrees);
  scene.time_step = 1e-4;
  const Vec3 half{0.5, 0.5, 0.1};
  GrainState grain;
  const double weight_per_area = scene.density * 0.2 * std::abs(scene.gravity.z);
  grain.position = {0, 0, half.z - weight_per_area / 1e7};
  Simulation simulation = scene.simulation(testing::box(half, 12, 0.02), grain);
  run_until(simulation, 0.1);
  const double early = simulation.grains().velocity[0].x;
  run_until(simulation, 0.5);
  return (simulation.grains().velocity[0].x - early) / 0.4;
}

TEST(BlockOnIncline, SticksBelowTheFrictionAngleAndSlidesAbove) {
  testing::VerificationTable table{"block_on_incline", "degrees,acceleration,closed_form"};
  for (const double degrees : {10.0, 20.0, 25.0, 28.0, 32.0, 40.0, 50.0}) {  // atan 0.5 = 26.57
    const double angle = degrees * std::numbers::pi / 180;
    const double expected = std::max(0.0, g * (std::sin(angle) - 0.5 * std::cos(angle)));
    const double found = block_acceleration(degrees);
    table.row({degrees, found, expected});
    EXPECT_NEAR(found, expected, 0.005 * g) << degrees << " degrees";
  }
}

TEST(SlidingSphere, RollsAtFiveSeventhsOfItsSpeed) {
  OneGrainOnPlane scene;
  scene.gravity = {0, 0, -g};
  scene.friction = 0.3;
  scene.law = {1e8, 1e8, 0.02};  // a strong dashpot would damp the rolling too
  scene.time_step = 2e-4;
  GrainState grain;
  grain.position = {0, 0, 1 - scene.resting_overlap(1)};
  grain.velocity = {2, 0, 0};
  Simulation simulation = scene.simulation(testing::sphere(1, 20000), grain);
  testing::VerificationTable table{"sliding_sphere", "time,velocity,closed_form"};
  double velocity = 0;
  double spin = 0;
  int samples = 0;
  while (simulation.time() < 0.52) {
    simulation.step();
    if (simulation.time() > 0.3) {
      velocity += simulation.grains().velocity[0].x;
      spin += norm(simulation.grains().angular_velocity_body[0]);
      ++samples;
    }
    if (simulation.step_number() % 50 == 0) {
      table.row({simulation.time(), simulation.grains().velocity[0].x,
                 std::max(2 - 0.3 * g * simulation.time(), 2 * 5.0 / 7)});
    }
  }
  // Once it rolls, the shear springs swing about the closed form with a period of 0.11 s.
  EXPECT_NEAR(velocity / samples, 2 * 5.0 / 7, 0.005 * 2);
  EXPECT_NEAR(spin / velocity, 1, 0.01);  // rolls without slip
}

TEST(RollingSphere, GainsFiveSeventhsOfTheSlope) {
  OneGrainOnPlane scene;
  scene.gravity = leaning_gravity(15);
  scene.law = {1e8, 1e8, 0.02};  // a strong dashpot would damp the rolling too
  scene.time_step = 2e-4;
  GrainState grain;
  grain.position = {0, 0, 1 - scene.resting_overlap(1)};
  Simulation simulation = scene.simulation(testing::sphere(1, 20000), grain);
  testing::VerificationTable table{"rolling_sphere", "time,velocity,closed_form"};
  while (simulation.time() < 0.6) {
    simulation.step();
    if (simulation.step_number() % 100 == 0) {
      table.row({simulation.time(), simulation.grains().velocity[0].x,
                 5.0 / 7 * scene.gravity.x * simulation.time()});
    }
  }
  EXPECT_NEAR(simulation.grains().velocity[0].x / (5.0 / 7 * scene.gravity.x * simulation.time()),
              1, 0.02);
}

}  // namespace
}  // namespace reckon
