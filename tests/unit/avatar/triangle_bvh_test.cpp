// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/triangle_bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "grids.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/random.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

Vec3 random_point(RandomStream& random, double low, double high) {
  const double x = random.uniform(low, high);
  const double y = random.uniform(low, high);
  return {x, y, random.uniform(low, high)};
}

TriangleMesh triangle_soup(RandomStream& random, int count) {
  TriangleMesh mesh;
  for (int n = 0; n < count; ++n) {
    const Vec3 at = random_point(random, -1, 1);
    for (int corner = 0; corner < 3; ++corner) {
      mesh.vertices.push_back(at + random_point(random, -0.2, 0.2));
    }
    const auto first = static_cast<std::uint32_t>(3 * n);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

// Minimises over a dense set of points of the triangle: an upper bound that closes in as 1/n.
double sampled_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr int n = 400;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; i + j <= n; ++j) {
      const double u = static_cast<double>(i) / n;
      const double v = static_cast<double>(j) / n;
      best = std::min(best, squared_norm(p - (a + u * (b - a) + v * (c - a))));
    }
  }
  return std::sqrt(best);
}

TEST(ClosestPointOnTriangle, MatchesDenseSampling) {
  RandomStream random{3, RandomPurpose::other, 0};
  for (int n = 0; n < 60; ++n) {
    const Vec3 a = random_point(random, -1, 1);
    const Vec3 b = random_point(random, -1, 1);
    const Vec3 c = n % 6 == 0 ? a + 0.3 * (b - a) : random_point(random, -1, 1);  // some needles
    const Vec3 p = random_point(random, -2, 2);
    const double found = std::sqrt(closest_point_on_triangle(p, a, b, c).squared_distance);
    const double sampled = sampled_distance(p, a, b, c);
    EXPECT_LE(found, sampled + 1e-12);
    EXPECT_GE(found, sampled - 0.01);
  }
}

TEST(ClosestPointOnTriangle, NamesTheFeature) {
  const Vec3 a{0, 0, 0};
  const Vec3 b{1, 0, 0};
  const Vec3 c{0, 1, 0};
  EXPECT_EQ(closest_point_on_triangle({0.2, 0.2, 1}, a, b, c).feature, TriangleFeature::face);
  const ClosestPoint edge = closest_point_on_triangle({1, 1, 1}, a, b, c);
  EXPECT_EQ(edge.feature, TriangleFeature::edge);
  EXPECT_EQ(edge.side, 1);
  EXPECT_DOUBLE_EQ(edge.squared_distance, 1.5);
  const ClosestPoint vertex = closest_point_on_triangle({-1, 3, 0}, a, b, c);
  EXPECT_EQ(vertex.feature, TriangleFeature::vertex);
  EXPECT_EQ(vertex.side, 2);
  EXPECT_EQ(vertex.point, c);
}

TEST(TriangleBvh, ClosestPointMatchesBruteForce) {
  RandomStream random{5, RandomPurpose::other, 0};
  for (const int count : {1, 2, 5, 9, 700}) {
    const TriangleMesh mesh = triangle_soup(random, count);
    const TriangleBvh bvh{mesh};
    for (int n = 0; n < 300; ++n) {
      const Vec3 p = random_point(random, -2, 2);
      ClosestPoint best;
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        ClosestPoint found = closest_point_on_triangle(p, mesh.vertices[mesh.triangles[t][0]],
                                                       mesh.vertices[mesh.triangles[t][1]],
                                                       mesh.vertices[mesh.triangles[t][2]]);
        found.triangle = t;
        if (found.squared_distance < best.squared_distance) best = found;
      }
      const ClosestPoint found = bvh.closest_point(p);
      ASSERT_EQ(found.squared_distance, best.squared_distance);
      ASSERT_EQ(found.triangle, best.triangle);
      ASSERT_EQ(found.point, best.point);
      const double distance = std::sqrt(best.squared_distance);
      const auto within = bvh.closest_point_within(p, 1.001 * distance);
      ASSERT_TRUE(within);
      ASSERT_EQ(within->triangle, best.triangle);
      ASSERT_FALSE(bvh.closest_point_within(p, 0.999 * distance));
    }
  }
}

TEST(TriangleBvh, OverlapsMatchBruteForce) {
  RandomStream random{7, RandomPurpose::other, 0};
  const TriangleMesh mesh = triangle_soup(random, 500);
  const TriangleBvh bvh{mesh};
  for (int n = 0; n < 200; ++n) {
    BoundingBox box;
    box.include(random_point(random, -1.2, 1.2));
    box.include(box.low + random_point(random, 0, 0.5));
    std::vector<std::uint32_t> expected;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      BoundingBox own;
      for (const std::uint32_t v : mesh.triangles[t]) own.include(mesh.vertices[v]);
      if (own.overlaps(box)) expected.push_back(t);
    }
    std::vector<std::uint32_t> found;
    bvh.for_each_overlap(box, [&](std::uint32_t t) { found.push_back(t); });
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected);
  }
}

TEST(TriangleBvh, SignedDistanceOfACubeIsExact) {
  const TriangleBvh bvh{test::cube(-1, 1)};
  RandomStream random{11, RandomPurpose::other, 0};
  for (int n = 0; n < 5000; ++n) {
    const Vec3 p = random_point(random, -2, 2);
    const Vec3 q{std::abs(p.x) - 1, std::abs(p.y) - 1, std::abs(p.z) - 1};
    const double outside = norm(Vec3{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)});
    const double expected = outside + std::min(std::max({q.x, q.y, q.z}), 0.0);
    ASSERT_NEAR(bvh.signed_distance(p), expected, 4e-15);
  }
  // On the diagonals edges and vertices are closest, and several triangles tie.
  EXPECT_DOUBLE_EQ(bvh.signed_distance({2, 2, 2}), std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(bvh.signed_distance({2, 2, 0}), std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(bvh.signed_distance({0, 0, 0}), -1.0);
  EXPECT_NEAR(bvh.signed_distance({1, 0.3, 0.2}), 0.0, 1e-15);
}

// In a thin tetrahedron a single face's normal gives the wrong sign for a third of the points near
// the sharp edges; the pseudo-normals must not.
TEST(TriangleBvh, SignIsRightBesideSharpEdges) {
  const Vec3 a{0, 0, 0};
  const Vec3 b{1, 0, 0};
  const Vec3 c{0.3, 1, 0};
  const Vec3 d{0.4, 0.3, 0.05};
  const TriangleBvh bvh{test::tetrahedron(a, b, c, d)};
  RandomStream random{13, RandomPurpose::other, 0};
  const double volume = dot(cross(b - a, c - a), d - a);
  ASSERT_GT(volume, 0);
  int inside_count = 0;
  for (int n = 0; n < 20000; ++n) {
    Vec3 p = random_point(random, -0.5, 1.5);
    p.z = random.uniform(-0.05, 0.1);
    // Inside is where all four barycentric coordinates are positive.
    const bool inside = dot(cross(p - a, c - a), d - a) > 0 &&
                        dot(cross(b - a, p - a), d - a) > 0 &&
                        dot(cross(b - a, c - a), p - a) > 0 && dot(cross(c - b, p - b), d - b) > 0;
    inside_count += inside ? 1 : 0;
    ASSERT_EQ(bvh.signed_distance(p) < 0, inside) << p.x << ' ' << p.y << ' ' << p.z;
  }
  EXPECT_GT(inside_count, 100);
}

TEST(TriangleBvh, ItsOrderHoldsEveryTriangleOnceWithNeighboursNearEachOther) {
  const TriangleMesh mesh = geodesic_sphere(20);
  std::vector<std::uint32_t> order = TriangleBvh{mesh}.tree_order();
  double step = 0;
  for (std::size_t n = 1; n < order.size(); ++n) {
    step += norm(mesh.vertices[mesh.triangles[order[n]][0]] -
                 mesh.vertices[mesh.triangles[order[n - 1]][0]]) /
            static_cast<double>(order.size());
  }
  EXPECT_LT(step, 0.2);  // chance would make it 4/3
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), mesh.triangles.size());
  for (std::uint32_t t = 0; t < order.size(); ++t) EXPECT_EQ(order[t], t);
}

TEST(TriangleBvh, RefusesWhatItCannotSearch) {
  EXPECT_THROW(TriangleBvh{TriangleMesh{}}, Error);
  TriangleMesh mesh = test::cube();
  mesh.triangles[3][1] = 8;
  EXPECT_THROW(TriangleBvh{mesh}, Error);
  mesh = test::cube();
  mesh.vertices[2].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(TriangleBvh{mesh}, Error);
}

}  // namespace
}  // namespace reckon
