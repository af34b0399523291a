// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/near_wall.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "reckon/contact/displacement_bound.hpp"
#include "support/random_motion.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

using testing::RandomMotion;

Shape known_sphere(double radius, int nodes) {
  Shape shape = testing::sphere(radius, nodes, 20);
  shape.sphere_radius = radius;
  return shape;
}

/// Area, volume and squared depth of a cap, to first order in its depth; nodes converge to them.
TEST(NearWall, SphereOnPlaneTouchesAsItsCapDoes) {
  const Shape shape = known_sphere(0.8, 20000);
  const ShapeView known{shape};
  Shape nodes = shape;
  nodes.sphere_radius = 0;
  const ShapeView of_nodes{nodes};
  const Vec3 normal = normalized(Vec3{1, -2, 2});
  const Wall wall{"plane", PlaneSurface{{1, 1, 1}, normal}, AreaLaw{1e6, 1e6, 0}, 0.3, false, {}};
  const auto sums = [&](const ShapeView& view, double depth) {
    GrainFrame grain{GrainId{0}, &view, Vec3{1, 1, 1} + (0.8 - depth) * normal};
    std::vector<Touch> touches;
    find_wall_touches(grain, wall, {}, touches);
    std::array<double, 3> sum{};
    Vec3 place;
    for (const Touch& touch : touches) {
      sum[0] += touch.area;
      sum[1] -= touch.area * touch.phi;
      sum[2] += touch.area * touch.phi * touch.phi;
      place += grain.position + touch.lever_world;
    }
    if (!touches.empty()) {
      place = place / static_cast<double>(touches.size());
      EXPECT_NEAR(dot(place - Vec3{1, 1, 1}, normal), 0, depth);
    }
    return sum;
  };
  const double depth = 0.03;
  const double pi_r = std::numbers::pi * 0.8;
  const auto found = sums(known, depth);
  EXPECT_NEAR(found[0], 2 * pi_r * depth, 1e-12);
  EXPECT_NEAR(found[1], pi_r * depth * depth, 1e-12);
  EXPECT_NEAR(found[2], 2.0 / 3 * pi_r * depth * depth * depth, 1e-12);
  const auto counted = sums(of_nodes, depth);
  for (const std::size_t n : {0U, 1U, 2U}) EXPECT_NEAR(counted[n] / found[n], 1, 0.03);
  EXPECT_EQ(sums(known, -1e-12)[0], 0);
}

/// A grain wanders along a wall that moves too. As NearList.MissesNoTouchWhateverTheMotion.
TEST(NearWall, MissesNoTouchWhateverTheMotion) {
  const std::vector<Shape> shapes{testing::bumpy_grain(1.0, 279, 18),
                                  testing::box({0.5, 0.8, 1}, 8, 0.1), known_sphere(0.7, 200)};
  const std::vector<ShapeView> views{shapes.begin(), shapes.end()};
  const AreaLaw law{1e6, 1e6, 0};
  const std::vector<Wall> walls{
      {"plane", PlaneSurface{{3, 1, 2}, normalized(Vec3{1, 2, 2})}, law, 0.3, false, {}},
      {"drum", CylinderSurface{{3, 1, 2}, normalized(Vec3{1, 0, 2}), 2.5}, law, 0.3, true, {}},
      {"ledge",
       LedgeSurface{{3, 1, 2}, normalized(Vec3{1, 2, 2}), normalized(Vec3{2, 1, -2})},
       law,
       0.3,
       false,
       {}}};
  std::uint64_t touched = 0;
  std::uint64_t slept = 0;
  ContactCounters counters;
  for (std::uint64_t walk = 0; walk < 300; ++walk) {
    RandomStream random{walk, RandomPurpose::other, 8};
    const Wall& wall = walls[walk % 3];
    std::vector<GrainFrame> frames{{GrainId{0}, &views[walk / 3 % 3]}};
    RandomMotion motion{random, frames[0], {3.2, 1.2, 2.2}};
    WallPose pose;
    double wall_path_length = 0;
    DisplacementBound displacements;
    NearWall list;
    double next_check = check_always;
    for (int step = 0; step < 400; ++step) {
      const double stride = std::exp2(random.uniform(-17, -1));
      const double from_wall = distance(wall, pose, frames[0].position);
      const Vec3 away =
          std::visit([&](const auto& s) { return s.gradient(frames[0].position); }, wall.surface);
      motion.move(stride, (from_wall > 1 ? -stride : from_wall < 0.3 ? stride : 0) * away);
      const Vec3 shift{random.uniform(-0.1, 0.1) * stride, 0, 0};
      pose.displacement += shift;
      wall_path_length = (wall_path_length + norm(shift)) * (1 + 1e-15);
      displacements.follow(frames);
      const double path_length = displacements.path_lengths()[0] + wall_path_length;
      std::vector<Touch> expected;
      find_wall_touches(frames[0], wall, pose, expected);
      if (path_length < next_check) {
        ASSERT_TRUE(expected.empty()) << "walk " << walk << " step " << step;
        ++slept;
        continue;
      }
      std::vector<Touch> found;
      next_check = list.find_touches(frames[0], wall, pose, path_length, found, counters);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t n = 0; n < found.size(); ++n) {
        ASSERT_EQ(found[n].node, expected[n].node);
        ASSERT_EQ(found[n].phi, expected[n].phi);
        ASSERT_EQ(found[n].lever_world, expected[n].lever_world);
        ASSERT_EQ(found[n].gradient_world, expected[n].gradient_world);
      }
      touched += expected.empty() ? 0U : 1U;
    }
  }
  EXPECT_GT(touched, 5000U);
  EXPECT_GT(slept, 5000U);
}

}  // namespace
}  // namespace reckon
