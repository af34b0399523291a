// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/enclosure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reckon/math/rotation.hpp"

namespace reckon {
namespace {

Wall plane(const Vec3& point, const Vec3& normal) {
  return {"plane", PlaneSurface{point, normalized(normal)}, AreaLaw{1, 1, 0, 0}, 0, false, {}};
}
std::vector<Wall> box(const Vec3& low, const Vec3& high, const Mat3& turn = {}) {
  std::vector<Wall> walls;
  for (const auto& row : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    walls.push_back(plane(turn * low, turn * row));
    walls.push_back(plane(turn * high, turn * -row));
  }
  return walls;
}
std::optional<Enclosure> space_in(const std::vector<Wall>& walls) {
  return enclosure_of(walls, std::vector<WallPose>(walls.size()));
}

TEST(Enclosure, BoxIsTheProductOfItsSides) {
  const auto space = space_in(box({-1, -2, 0}, {2, 2, 5}));
  ASSERT_TRUE(space.has_value());
  EXPECT_EQ(space->volume, 60);
  EXPECT_EQ(space->size(), (Vec3{3, 4, 5}));
  EXPECT_EQ(space->areas, (std::vector<double>{20, 20, 15, 15, 12, 12}));
}

/// Halves that have slid past each other keep the volume; where they overlap counts half-way.
TEST(Enclosure, ShearBoxIsTheSumOfItsHalves) {
  const auto ledge = [](const Vec3& point, const Vec3& normal, const Vec3& top) {
    return Wall{"ledge", LedgeSurface{point, normal, top}, AreaLaw{1, 1, 0, 0}, 0, false, {}};
  };
  const auto shear_box = [&](const Mat3& turn) {
    const auto placed = [&](const Vec3& point, const Vec3& normal) {
      return plane(turn * point, turn * normal);
    };
    const auto turned = [&](const Vec3& point, const Vec3& normal, const Vec3& top) {
      return ledge(turn * point, turn * normal, turn * top);
    };
    return std::vector<Wall>{placed({0, 0, -2}, {0, 0, 1}),
                             placed({0, 0, 3}, {0, 0, -1}),
                             placed({0, 0, 0}, {0, 1, 0}),
                             placed({0, 4, 0}, {0, -1, 0}),
                             turned({0, 0, 0.1}, {1, 0, 0}, {0, 0, 1}),
                             turned({6, 0, 0.1}, {-1, 0, 0}, {0, 0, 1}),
                             turned({0, 0, -0.1}, {1, 0, 0}, {0, 0, -1}),
                             turned({6, 0, -0.1}, {-1, 0, 0}, {0, 0, -1})};
  };
  const Mat3 askew = rotation_matrix(normalized(Quaternion{0.8, 0.1, -0.3, 0.4}));
  for (const Mat3& turn : {Mat3{}, askew}) {
    const std::vector<Wall> walls = shear_box(turn);
    std::vector<WallPose> poses(8);
    poses[6].displacement = poses[7].displacement = turn * Vec3{1.5, 0, 0};
    poses[1].displacement = turn * Vec3{1.5, 0, -0.5};
    const auto space = enclosure_of(walls, poses);
    ASSERT_TRUE(space.has_value());
    EXPECT_NEAR(space->volume, 6 * 4 * 4.5, 1e-9);
    ASSERT_EQ(space->areas.size(), 8U);
    EXPECT_NEAR(space->areas[0], 24, 1e-9);
    EXPECT_NEAR(space->areas[1], 24, 1e-9);
    EXPECT_NEAR(space->areas[2], 6 * 4.5, 1e-9);
    EXPECT_NEAR(space->areas[4], 8, 1e-9);
    EXPECT_NEAR(space->areas[6], 10, 1e-9);
    if (turn == Mat3{}) {
      EXPECT_NEAR(norm(space->size() - Vec3{7.5, 4, 4.5}), 0, 1e-12);
    }
  }
  std::vector<Wall> lower = shear_box({});
  lower.resize(6);
  EXPECT_FALSE(space_in(lower).has_value());
}

TEST(Enclosure, FollowsTheWalls) {
  const auto walls = box({0, 0, 0}, {1, 1, 1});
  std::vector<WallPose> poses(6);
  poses[5].displacement = {9, 9, -0.25};  // along the plane it changes nothing
  EXPECT_EQ(enclosure_of(walls, poses)->volume, 0.75);
}

TEST(Enclosure, TurnedBoxIsTheSameBox) {
  const Mat3 turn = rotation_matrix(normalized(Quaternion{0.7, 0.2, -0.5, 0.4}));
  const auto space = space_in(box({-1, -2, 0}, {2, 2, 5}, turn));
  ASSERT_TRUE(space.has_value());
  EXPECT_NEAR(space->volume, 60, 1e-9);
  const std::vector<double> areas{20, 20, 15, 15, 12, 12};
  for (std::size_t w = 0; w < 6; ++w) EXPECT_NEAR(space->areas[w], areas[w], 1e-10);
}

TEST(Enclosure, CutCornerOfACubeIsATetrahedronLess) {
  // The plane x + y + z = 2.5 cuts off a corner with legs 1/2.
  auto walls = box({0, 0, 0}, {1, 1, 1});
  walls.push_back(plane({1, 1, 0.5}, {-1, -1, -1}));
  const auto space = space_in(walls);
  ASSERT_TRUE(space.has_value());
  EXPECT_NEAR(space->volume, 1 - 0.125 / 6, 1e-12);
  EXPECT_NEAR(space->areas[6], std::sqrt(3.0) / 4 * 0.5, 1e-12);  // equilateral, side sqrt(1/2)
  EXPECT_NEAR(space->areas[1], 1 - 0.125, 1e-12);
}

TEST(Enclosure, WallThatBoundsNothingHasNoArea) {
  auto walls = box({0, 0, 0}, {1, 1, 1});
  walls.push_back(plane({0, 0, -1}, {0, 0, 1}));
  EXPECT_EQ(space_in(walls)->areas[6], 0);
  EXPECT_EQ(space_in(walls)->volume, 1);
}

TEST(Enclosure, CylinderBetweenPlatens) {
  const Vec3 axis = normalized(Vec3{1, 2, 2});
  std::vector<Wall> walls{plane(3.0 * axis, axis), plane(7.0 * axis, -axis)};
  walls.push_back({"tube", CylinderSurface{{0, 0, 0}, axis, 2}, AreaLaw{1, 1, 0, 0}, 0, false, {}});
  const auto space = space_in(walls);
  ASSERT_TRUE(space.has_value());
  EXPECT_NEAR(space->volume, std::numbers::pi * 4 * 4, 1e-12);
  EXPECT_NEAR(space->areas[0], std::numbers::pi * 4, 1e-12);
  EXPECT_NEAR(space->areas[2], 2 * std::numbers::pi * 2 * 4, 1e-12);
}

TEST(Enclosure, OpenOrEmptySpaceIsNone) {
  auto walls = box({0, 0, 0}, {1, 1, 1});
  std::vector<WallPose> crossed(6);
  crossed[1].displacement = {-2, 0, 0};
  EXPECT_FALSE(enclosure_of(walls, crossed).has_value());
  walls.pop_back();
  EXPECT_FALSE(space_in(walls).has_value());
  walls = box({0, 0, 0}, {1, 1, 1}, rotation_matrix(normalized(Quaternion{1, 1, 0.5, 0})));
  walls.pop_back();
  EXPECT_FALSE(space_in(walls).has_value());
  EXPECT_FALSE(space_in({}).has_value());
}

}  // namespace
}  // namespace reckon
