// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/neighbor/space_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "reckon/core/random.hpp"

namespace reckon {
namespace {

TEST(SpaceOrder, FollowsTheMortonCurve) {
  // The corners of a cube along the curve, x fastest; then the same shuffled.
  std::vector<Vec3> curve;
  for (int n = 0; n < 8; ++n) curve.push_back(Vec3{1.0 * (n & 1), 0.5 * (n & 2), 0.25 * (n & 4)});
  const std::vector<std::uint32_t> shuffle{5, 0, 7, 2, 1, 6, 3, 4};
  std::vector<Vec3> shuffled;
  for (const std::uint32_t n : shuffle) shuffled.push_back(curve[n]);
  const std::vector<std::uint32_t> order = space_order(shuffled);
  for (std::size_t n = 0; n < 8; ++n) EXPECT_EQ(shuffled[order[n]], curve[n]);
}

TEST(SpaceOrder, KeepsTheOrderOfPointsInOnePlace) {
  const std::vector<Vec3> points(5, Vec3{1, 2, 3});
  EXPECT_EQ(space_order(points), (std::vector<std::uint32_t>{0, 1, 2, 3, 4}));
  EXPECT_TRUE(space_order({}).empty());
}

TEST(SpaceOrder, MakesNeighboursOfNeighbours) {
  RandomStream random{3, RandomPurpose::other, 1};
  std::vector<Vec3> points;
  for (int n = 0; n < 4096; ++n) {
    points.push_back({random.uniform(), random.uniform(), random.uniform()});
  }
  const std::vector<std::uint32_t> order = space_order(points);
  std::vector<std::uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t n = 0; n < sorted.size(); ++n) ASSERT_EQ(sorted[n], n);
  const auto mean_leap = [&](const std::vector<std::uint32_t>& path) {
    double sum = 0;
    for (std::size_t n = 1; n < path.size(); ++n)
      sum += norm(points[path[n]] - points[path[n - 1]]);
    return sum / static_cast<double>(path.size() - 1);
  };
  // Random points of the unit cube are 0.66 apart on average; points of one cell of 1/16 can be
  // reached in a tenth.
  EXPECT_GT(mean_leap(sorted), 0.6);
  EXPECT_LT(mean_leap(order), 0.1);
}

}  // namespace
}  // namespace reckon
