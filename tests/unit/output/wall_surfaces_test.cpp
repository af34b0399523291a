// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/wall_surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace reckon {
namespace {

Wall plane(const Vec3& point, const Vec3& normal) {
  Wall wall;
  wall.surface = PlaneSurface{point, normalized(normal)};
  return wall;
}
Wall cylinder(const Vec3& point, const Vec3& axis, double radius) {
  Wall wall;
  wall.surface = CylinderSurface{point, normalized(axis), radius};
  return wall;
}
std::vector<Wall> box(const Vec3& high) {
  return {plane({}, {1, 0, 0}),    plane(high, {-1, 0, 0}), plane({}, {0, 1, 0}),
          plane(high, {0, -1, 0}), plane({}, {0, 0, 1}),    plane(high, {0, 0, -1})};
}

/// Areas of a wall's polygons, added up.
double area(const WallPolygons& drawn, std::uint32_t wall) {
  double sum = 0;
  std::int64_t begin = 0;
  for (std::size_t polygon = 0; polygon < drawn.wall.size(); ++polygon) {
    const std::int64_t end = drawn.polygons.offsets[polygon];
    Vec3 twice;
    const auto corner = [&](std::int64_t n) -> const Vec3& {
      const std::int64_t point = drawn.polygons.connectivity[static_cast<std::size_t>(n)];
      return drawn.corners[static_cast<std::size_t>(point)];
    };
    for (std::int64_t n = begin + 1; n + 1 < end; ++n) {
      twice += cross(corner(n) - corner(begin), corner(n + 1) - corner(begin));
    }
    if (drawn.wall[polygon] == wall) sum += 0.5 * norm(twice);
    begin = end;
  }
  return sum;
}

constexpr Extent grains_of_box{{0.1, 0.1, 0.1}, {0.9, 1.9, 2.9}};

TEST(WallPolygons, ABoxHasItsSixFaces) {
  const std::vector<Wall> walls = box({1, 2, 3});
  const std::vector<Vec3> rest(6);
  const WallPolygons drawn = wall_polygons(walls, rest, grains_of_box, std::nullopt);
  ASSERT_EQ(drawn.wall.size(), 6U);
  for (std::uint32_t wall = 0; wall < 6; ++wall) {
    EXPECT_NEAR(area(drawn, wall), wall < 2 ? 6 : wall < 4 ? 3 : 2, 1e-12);
  }
  for (const Vec3& corner : drawn.corners) {  // each is a corner of the box
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(corner[axis] * (corner[axis] - Vec3{1, 2, 3}[axis]), 0, 1e-12);
    }
  }
}

TEST(WallPolygons, FollowTheirWallsAndEndNearTheGrainsWhereNothingElseStops) {
  std::vector<Wall> walls = box({1, 2, 3});
  std::vector<Vec3> moved(6);
  moved[5] = {0, 0, -1};  // the top comes down
  EXPECT_NEAR(area(wall_polygons(walls, moved, grains_of_box, std::nullopt), 0), 2 * 2, 1e-12);
  walls.pop_back();  // an open top
  const double margin = 0.06 * norm(grains_of_box.high - grains_of_box.low);
  EXPECT_NEAR(area(wall_polygons(walls, moved, grains_of_box, std::nullopt), 0), 2 * (2.9 + margin),
              1e-12);
}

/// The lower left side of a shear box: what faces the grains, and the top as far as it is drawn.
TEST(WallPolygons, ALedgeHasTwoFacesThatEndAtItsEdge) {
  std::vector<Wall> walls = box({1, 2, 3});
  walls[0].surface = LedgeSurface{{0, 0, 1}, {1, 0, 0}, {0, 0, 1}};
  const std::vector<Vec3> rest(6);
  const WallPolygons drawn = wall_polygons(walls, rest, grains_of_box, std::nullopt);
  const double margin = 0.06 * norm(grains_of_box.high - grains_of_box.low);
  EXPECT_NEAR(area(drawn, 0), 2 * 1 + 2 * (margin - 0.1), 1e-12);
  EXPECT_NEAR(area(drawn, 1), 2 * 3, 1e-12);
}

TEST(WallPolygons, PlatesInACylinderAreRoundAndEndIt) {
  const std::vector<Wall> walls{cylinder({5, 0, 0}, {0, 0, 1}, 2), plane({}, {0, 0, 1}),
                                plane({0, 0, 3}, {0, 0, -1})};
  const std::vector<Vec3> rest(3);
  const Extent grains{{3, -2, 0}, {7, 2, 3}};
  const WallPolygons drawn = wall_polygons(walls, rest, grains, std::nullopt);
  const double ring = 72 * std::sin(std::numbers::pi / 72);  // of a polygon of 72 sides in a circle
  EXPECT_NEAR(area(drawn, 0), 2 * 2 * ring * 3, 1e-9);
  const double disc = 4 * ring * std::cos(std::numbers::pi / 72);
  EXPECT_NEAR(area(drawn, 1), disc, 1e-9);
  EXPECT_NEAR(area(drawn, 2), disc, 1e-9);
  const WallPolygons without = wall_polygons(walls, rest, grains, 0);
  EXPECT_EQ(area(without, 0), 0);
  EXPECT_EQ(without.wall.size(), 2U);
}

TEST(WallPolygons, ASlantedPlaneIsCutByWhatItMeets) {
  std::vector<Wall> walls = box({1, 1, 1});
  walls.push_back(plane({0.5, 0, 0}, {-1, 0, 1}));  // an edge of the floor is taken off
  const std::vector<Vec3> rest(7);
  const Extent grains{{0, 0, 0}, {1, 1, 1}};
  const WallPolygons drawn = wall_polygons(walls, rest, grains, std::nullopt);
  EXPECT_NEAR(area(drawn, 6), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(area(drawn, 4), 0.5, 1e-12);
}

TEST(WallPolygons, ClippingKeepsTheSideOfTheNormal) {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  EXPECT_EQ(clipped(square, {{0.25, 0, 0}, {1, 0, 0}}),
            (std::vector<Vec3>{{0.25, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.25, 1, 0}}));
  EXPECT_TRUE(clipped(square, {{2, 0, 0}, {1, 0, 0}}).empty());
}

}  // namespace
}  // namespace reckon
