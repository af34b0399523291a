// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/shape/node_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reckon/core/random.hpp"

namespace reckon {
namespace {

/// Points of a Fibonacci spiral on the unit sphere: even, but in an order that winds around.
SurfaceNodes spiral(std::size_t count) {
  SurfaceNodes nodes;
  for (std::size_t n = 0; n < count; ++n) {
    const double z = 1 - (2 * static_cast<double>(n) + 1) / static_cast<double>(count);
    const double angle = 2 * std::numbers::pi * static_cast<double>(n) / std::numbers::phi;
    const double r = std::sqrt(1 - z * z);
    nodes.x.push_back(r * std::cos(angle));
    nodes.y.push_back(r * std::sin(angle));
    nodes.z.push_back(z);
    nodes.area.push_back(static_cast<double>(n));
  }
  return nodes;
}

TEST(NodeClusters, HoldTheirNodesAndCoverAllOfThem) {
  for (const std::size_t count : {1UL, 15UL, 16UL, 17UL, 279UL}) {
    const SurfaceNodes nodes = in_compact_order(spiral(count));
    const auto clusters = make_clusters(nodes);
    std::uint32_t next = 0;
    for (const NodeCluster& cluster : clusters) {
      EXPECT_EQ(cluster.first, next);
      EXPECT_GE(cluster.count, 1U);
      EXPECT_LE(cluster.count, nodes_per_cluster);
      for (std::uint32_t n = next; n < next + cluster.count; ++n) {
        EXPECT_LE(norm(nodes.position(n) - cluster.center_body), cluster.radius);
      }
      next += cluster.count;
    }
    EXPECT_EQ(next, count);
    EXPECT_EQ(clusters.size(), (count + 15) / 16);
  }
}

TEST(NodeOrder, KeepsEveryNodeWithItsArea) {
  const SurfaceNodes before = spiral(300);
  const SurfaceNodes after = in_compact_order(before);
  ASSERT_EQ(after.size(), 300U);
  std::vector<bool> seen(300, false);
  for (std::size_t n = 0; n < 300; ++n) {
    const auto old = static_cast<std::size_t>(after.area[n]);
    EXPECT_FALSE(seen[old]);
    seen[old] = true;
    EXPECT_EQ(after.position(n), before.position(old));
  }
}

// A flat disc that holds 16 nodes of equal area has the least radius that any cluster can have.
TEST(NodeOrder, ClustersAreCloseToTheirIdealSize) {
  for (const std::size_t count : {280UL, 1000UL, 5000UL}) {
    const SurfaceNodes nodes = in_compact_order(spiral(count));
    double mean = 0;
    const auto clusters = make_clusters(nodes);
    for (const NodeCluster& cluster : clusters) {
      mean += cluster.radius / static_cast<double>(clusters.size());
    }
    const double ideal = std::sqrt(16 * 4 / static_cast<double>(count));
    EXPECT_LT(mean / ideal, 1.35) << count;
    EXPECT_GT(mean / ideal, 0.8) << count;
  }
}

TEST(NodeOrder, DoesNotDependOnTheOrderThatComesIn) {
  const SurfaceNodes nodes = spiral(500);
  std::vector<Vec3> points;
  for (std::size_t n = 0; n < 500; ++n) points.push_back(nodes.position(n));
  const auto sorted = [](const std::vector<Vec3>& from) {
    std::vector<Vec3> to;
    for (const std::uint32_t n : compact_order(from, 16)) to.push_back(from[n]);
    return to;
  };
  std::vector<Vec3> shuffled = points;
  RandomStream random{1, RandomPurpose::other, 0};
  for (std::size_t n = 499; n > 0; --n) {
    std::swap(shuffled[n],
              shuffled[static_cast<std::size_t>(random.uniform() * static_cast<double>(n + 1))]);
  }
  EXPECT_EQ(sorted(points), sorted(shuffled));
}

}  // namespace
}  // namespace reckon
