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

/// Against the nearest of many points on both faces.
TEST(WallSurface, DistanceToALedgeIsExactInsideAndOutside) {
  const LedgeSurface ledge{{1, 5, 2}, normalized(Vec3{3, 0, 4}), normalized(Vec3{-4, 0, 3})};
  const Vec3 along = cross(ledge.normal_unit, ledge.top_unit);
  int inside = 0;
  for (int a = -6; a <= 6; ++a) {
    for (int b = -6; b <= 6; ++b) {
      const double beside = 0.31 * a + 0.01;
      const double above = 0.29 * b - 0.02;
      const Vec3 p =
          ledge.point + beside * ledge.normal_unit + above * ledge.top_unit + 0.7 * along;
      double nearest = 1e9;
      Vec3 foot;
      for (int n = 0; n <= 4000; ++n) {  // down the side, and back along the top
        const double t = -0.001 * n;
        for (const Vec3& q : {t * ledge.top_unit, t * ledge.normal_unit}) {
          const Vec3 on = ledge.point + q + 0.7 * along;
          if (norm(p - on) < nearest) {
            nearest = norm(p - on);
            foot = on;
          }
        }
      }
      const bool is_inside = beside < 0 && above < 0;
      inside += is_inside ? 1 : 0;
      EXPECT_NEAR(ledge.distance(p), is_inside ? -nearest : nearest, 1e-5);
      EXPECT_NEAR(norm(ledge.gradient(p)), 1, 1e-14);
      const Vec3 to_face = p - ledge.distance(p) * ledge.gradient(p);
      EXPECT_LT(norm(to_face - foot), 2e-3);
    }
  }
  EXPECT_EQ(inside, 42);
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
