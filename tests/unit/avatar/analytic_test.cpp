// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/analytic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "expect_error.hpp"
#include "reckon/avatar/half_edges.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/core/random.hpp"

namespace reckon {
namespace {

using std::numbers::pi;

void expect_closed(const TriangleMesh& mesh) {
  const auto edges = sorted_half_edges(mesh);
  ASSERT_EQ(edges.size() % 2, 0U);
  for (std::size_t e = 0; e < edges.size(); e += 2) {
    ASSERT_TRUE(edges[e].same_edge(edges[e + 1]));
    ASSERT_NE(edges[e].ascending, edges[e + 1].ascending);
    ASSERT_TRUE(e + 2 == edges.size() || !edges[e].same_edge(edges[e + 2]));
  }
}

struct Expected {
  double volume;
  Vec3 inertia;
  double area;  // 0 where there is no closed form
};

/// Every error must fall with the square of the edge, which is one over the number of triangles,
/// give or take `slack` of an order.
void expect_second_order(const std::function<TriangleMesh(double)>& mesh, double edge,
                         const Expected& expected, double slack = 0.1) {
  std::vector<double> before;
  double triangles_before = 0;
  for (const double h : {edge, edge / 2, edge / 4}) {
    const TriangleMesh surface = mesh(h);
    expect_closed(surface);
    const auto triangles = static_cast<double>(surface.triangles.size());
    const SolidProperties solid = solid_properties(surface);
    EXPECT_LT(norm(solid.centroid), 1e-10);
    std::vector<double> errors{solid.volume / expected.volume - 1,
                               solid.inertia.row_x.x / expected.inertia.x - 1,
                               solid.inertia.row_y.y / expected.inertia.y - 1,
                               solid.inertia.row_z.z / expected.inertia.z - 1};
    if (expected.area > 0) errors.push_back(solid.surface_area / expected.area - 1);
    for (std::size_t n = 0; n < before.size(); ++n) {
      const double order =
          2 * std::log(before[n] / errors[n]) / std::log(triangles / triangles_before);
      EXPECT_NEAR(order, 2, slack) << "quantity " << n << ", edge " << h;
    }
    before = errors;
    triangles_before = triangles;
  }
}

TEST(AnalyticSolids, SphereConverges) {
  const double r = 1.5;
  const double volume = 4 * pi / 3 * r * r * r;
  const double inertia = 0.4 * volume * r * r;
  expect_second_order([&](double h) { return sphere_mesh(r, h); }, 0.2,
                      {volume, {inertia, inertia, inertia}, 4 * pi * r * r});
}

TEST(AnalyticSolids, EllipsoidConverges) {
  // Prolate about z: area 2 pi a^2 (1 + c/(a e) asin e).
  const double a = 0.7;
  const double c = 1.2;
  const double e = std::sqrt(1 - a * a / (c * c));
  const double volume = 4 * pi / 3 * a * a * c;
  expect_second_order(
      [&](double h) {
        return ellipsoid_mesh({a, a, c}, h);
      },
      0.2,
      {volume,
       {volume / 5 * (a * a + c * c), volume / 5 * (a * a + c * c), volume / 5 * 2 * a * a},
       2 * pi * a * a * (1 + c / (a * e) * std::asin(e))});
  for (const Vec3& v : ellipsoid_mesh({1, 2, 3}, 0.3).vertices) {
    EXPECT_NEAR(v.x * v.x + v.y * v.y / 4 + v.z * v.z / 9, 1, 1e-15);
  }
}

// Published case: half-extents (.4, 1, .8), exponents (.4, 1.6).
TEST(AnalyticSolids, SuperellipsoidHasItsPublishedMass) {
  const Superellipsoid solid{{0.4, 1, 0.8}, 0.4, 1.6};
  const SolidProperties fine = solid_properties(superellipsoid_mesh(solid, 0.01));
  EXPECT_NEAR(fine.volume, 1.0864027, 2e-4);
  EXPECT_NEAR(fine.inertia.row_x.x, 0.318410, 1e-4);
  EXPECT_NEAR(fine.inertia.row_y.y, 0.128351, 1e-4);
  EXPECT_NEAR(fine.inertia.row_z.z, 0.262462, 1e-4);
  expect_second_order([&](double h) { return superellipsoid_mesh(solid, h); }, 0.08,
                      {1.08640266, {0.31840998, 0.12835131, 0.26246197}, 0}, 0.25);
  for (const Vec3& v : superellipsoid_mesh(solid, 0.1).vertices) {
    const double outline = std::pow(std::abs(v.x) / 0.4, 5) + std::pow(std::abs(v.y), 5);
    EXPECT_NEAR(std::pow(outline, 0.25) + std::pow(std::abs(v.z) / 0.8, 1.25), 1, 1e-13);
  }
}

TEST(AnalyticSolids, SuperellipsoidLimits) {
  // Exponents 1 are an ellipsoid, exponents 2 an octahedron, small ones nearly a box.
  for (const Vec3& v : superellipsoid_mesh({{1, 2, 3}, 1, 1}, 0.5).vertices) {
    EXPECT_NEAR(v.x * v.x + v.y * v.y / 4 + v.z * v.z / 9, 1, 1e-14);
  }
  const auto volume = [](double exponent) {
    return solid_properties(superellipsoid_mesh({{1, 1, 1}, exponent, exponent}, 0.05)).volume;
  };
  EXPECT_NEAR(volume(2), 4.0 / 3, 1e-12);
  EXPECT_NEAR(volume(0.05), 8, 0.1);
}

TEST(AnalyticSolids, BoxIsExact) {
  for (const double edge : {10.0, 0.9, 0.25}) {
    const TriangleMesh mesh = box_mesh({1, 2, 1.5}, edge);
    expect_closed(mesh);
    const SolidProperties solid = solid_properties(mesh);
    EXPECT_NEAR(solid.volume, 24, 1e-12);
    EXPECT_NEAR(solid.surface_area, 52, 1e-12);
    EXPECT_NEAR(solid.inertia.row_x.x, 24.0 / 3 * (4 + 2.25), 1e-11);
    EXPECT_NEAR(solid.inertia.row_z.z, 24.0 / 3 * (1 + 4), 1e-11);
    for (const Vec3& v : mesh.vertices) EXPECT_EQ(BoxDistance({1, 2, 1.5})(v), 0);
  }
}

TEST(AnalyticSolids, CylinderConvergesAndKeepsItsRims) {
  const double r = 0.8;
  const double half = 0.5;
  const double volume = pi * r * r * 2 * half;
  const double across = volume * (r * r / 4 + half * half / 3);
  expect_second_order(
      [&](double h) { return cylinder_mesh(r, half, h); }, 0.1,
      {volume, {across, across, volume * r * r / 2}, 2 * pi * r * r + 2 * pi * r * 2 * half});
  int on_rim = 0;
  for (const Vec3& v : cylinder_mesh(r, half, 0.1).vertices) {
    EXPECT_NEAR((CylinderDistance{r, half}(v)), 0, 2e-16);
    on_rim += std::abs(v.z) == half && std::abs(std::hypot(v.x, v.y) - r) < 1e-15 ? 1 : 0;
  }
  EXPECT_EQ(on_rim, 2 * static_cast<int>(std::ceil(2 * pi * r / 0.1)));
}

// The distance functors against the distance to a mesh, which is independent of them.
TEST(AnalyticSolids, DistancesAgreeWithMeshes) {
  const TriangleBvh box{box_mesh({0.5, 0.8, 0.6}, 1)};
  const TriangleBvh cylinder{cylinder_mesh(0.7, 0.4, 0.01)};
  const TriangleBvh sphere{sphere_mesh(0.9, 0.04)};
  RandomStream random{1, RandomPurpose::other, 0};
  for (int n = 0; n < 2000; ++n) {
    const double x = random.uniform(-1.5, 1.5);
    const double y = random.uniform(-1.5, 1.5);
    const Vec3 p{x, y, random.uniform(-1.5, 1.5)};
    ASSERT_NEAR((BoxDistance{{0.5, 0.8, 0.6}}(p)), box.signed_distance(p), 1e-14);
    ASSERT_NEAR((CylinderDistance{0.7, 0.4}(p)), cylinder.signed_distance(p), 3e-5);
    ASSERT_NEAR(SphereDistance{0.9}(p), sphere.signed_distance(p), 1e-3);
  }
}

TEST(AnalyticSolids, BadSizesAreRefused) {
  using test::expect_error;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  expect_error([] { (void)sphere_mesh(0, 0.1); }, {"half-axis of 0.0"});
  expect_error([&] { (void)ellipsoid_mesh({1, nan, 1}, 0.1); }, {"ellipsoid", "nan"});
  expect_error([] { (void)sphere_mesh(1, 0); }, {"edge"});
  expect_error([] { (void)sphere_mesh(1, 1e-9); }, {"longer edge"});
  expect_error([&] { (void)box_mesh({1, 1, infinity}, 0.1); }, {"box", "inf"});
  expect_error([] { (void)box_mesh({1, 1, 1}, 1e-300); }, {"box", "longer target edge"});
  expect_error([] { (void)cylinder_mesh(-1, 1, 0.1); }, {"cylinder", "radius of -1"});
  expect_error([] { (void)cylinder_mesh(1, 0, 0.1); }, {"cylinder", "half-height"});
  expect_error([] { (void)superellipsoid_mesh({{1, 1, 1}, 3, 1}, 0.1); }, {"exponent of 3"});
  expect_error([&] { (void)superellipsoid_mesh({{1, 1, 1}, 1, nan}, 0.1); }, {"exponent of nan"});
}

}  // namespace
}  // namespace reckon
