// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/wall.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace reckon {
namespace {

TEST(WallSurface, DistanceIsPositiveWhereGrainsMayBe) {
  const PlaneSurface floor{{0, 0, 1}, {0, 0, 1}};
  EXPECT_DOUBLE_EQ(floor.distance({5, 5, 3}), 2);
  EXPECT_DOUBLE_EQ(floor.distance({5, 5, 0.5}), -0.5);
  const CylinderSurface tube{{1, 0, 0}, {0, 0, 1}, 2};
  EXPECT_DOUBLE_EQ(tube.distance({1, 0, 9}), 2);
  EXPECT_DOUBLE_EQ(tube.distance({1, 3, -9}), -1);
  EXPECT_EQ(tube.gradient({1, 3, 0}), (Vec3{0, -1, 0}));  // back to the axis
}

TEST(WallMotion, VelocityIsTheDisplacementOverTheLastStep) {
  Wall wall;
  wall.motion = WallMotion{.velocity = {0, 0, -0.5},
                           .amplitude = {0.1, 0, 0},
                           .frequency = 2,
                           .start = 0.2,
                           .stop = 1.0};
  const double dt = 0.001;
  EXPECT_EQ(pose_at(wall, 100, dt).displacement, Vec3{});
  EXPECT_EQ(pose_at(wall, 100, dt).velocity, Vec3{});
  const WallPose moving = pose_at(wall, 500, dt);
  EXPECT_NEAR(moving.displacement.z, -0.5 * 0.3, 1e-14);
  EXPECT_NEAR(moving.displacement.x, 0.1 * std::sin(2 * std::numbers::pi * 0.6), 1e-14);
  EXPECT_NEAR(moving.velocity.z, -0.5, 1e-10);
  const WallPose stopped = pose_at(wall, 5000, dt);
  EXPECT_EQ(stopped.velocity, Vec3{});
  EXPECT_NEAR(stopped.displacement.z, -0.4, 1e-14);
}

}  // namespace
}  // namespace reckon
