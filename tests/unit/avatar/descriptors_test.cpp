// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/descriptors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grids.hpp"
#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/shape_builder.hpp"
#include "reckon/core/random.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

ShapeDescriptors describe(const TriangleMesh& mesh) {
  const TriangleBvh bvh{mesh};
  const SolidProperties solid = solid_properties(mesh);
  const double diameter = std::cbrt(6 * solid.volume / std::numbers::pi);
  return describe_shape(mesh, bvh, solid, sample_signed_distance(bvh, diameter / 20));
}

TEST(ConvexHull, KnownVolumes) {
  EXPECT_NEAR(convex_hull_volume(test::cube(-1, 2).vertices), 27, 1e-9);
  const auto sphere = geodesic_sphere(8);
  EXPECT_NEAR(convex_hull_volume(sphere.vertices) / solid_properties(sphere).volume, 1, 1e-5);
  EXPECT_EQ(convex_hull_volume(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), 0);
  EXPECT_EQ(convex_hull_volume(std::vector<Vec3>(10, Vec3{1, 2, 3})), 0);
  EXPECT_EQ(convex_hull_volume(std::vector<Vec3>{{0, 0, 0}, {1, 1, 0}, {2, 0, 0}, {0, 2, 0}}), 0);
}

// Lattice points: most of them coplanar with facets, many collinear with edges.
TEST(ConvexHull, PointsOnFacesEdgesAndInsideChangeNothing) {
  std::vector<Vec3> points;
  for (int k = 0; k <= 4; ++k) {
    for (int j = 0; j <= 4; ++j) {
      for (int i = 0; i <= 4; ++i) {
        points.push_back({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
      }
    }
  }
  EXPECT_NEAR(convex_hull_volume(points), 64, 1e-9);
  // Cutting the corner lattice point off removes a tetrahedron of volume 1/6.
  points.erase(points.begin());
  EXPECT_NEAR(convex_hull_volume(points), 64 - 1.0 / 6, 1e-9);
}

TEST(ConvexHull, NoPointLiesOutside) {
  RandomStream random{3, RandomPurpose::other, 0};
  std::vector<Vec3> points;
  for (int n = 0; n < 3000; ++n) {
    const double x = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    const double z = random.uniform(-1, 1);
    if (squared_norm({x, y, z}) < 1) points.push_back({x, y, z});
  }
  const double volume = convex_hull_volume(points);
  EXPECT_GT(volume, 0.85 * 4 * std::numbers::pi / 3);
  EXPECT_LT(volume, 4 * std::numbers::pi / 3);
  // Monotone: points inside change nothing, a point outside adds a cone.
  std::vector<Vec3> more = points;
  for (const Vec3& p : points) more.push_back(0.9 * p);
  EXPECT_NEAR(convex_hull_volume(more), volume, 1e-6);
  more.push_back({0, 0, 3});
  EXPECT_GT(convex_hull_volume(more), volume + 0.5);
}

TEST(ShapeDescriptors, SphereIsOneInEverything) {
  const ShapeDescriptors d = describe(geodesic_sphere(20));
  EXPECT_NEAR(d.length, 2, 1e-6);
  EXPECT_NEAR(d.equivalent_diameter, 2, 0.01);
  EXPECT_NEAR(d.elongation, 1, 0.01);
  EXPECT_NEAR(d.flatness, 1, 0.01);
  EXPECT_NEAR(d.sphericity, 1, 1e-3);
  EXPECT_NEAR(d.convexity, 1, 1e-5);
  EXPECT_NEAR(d.roundness, 1, 0.03);
}

TEST(ShapeDescriptors, BoxHasItsKnownForm) {
  const ShapeDescriptors d = describe(test::stretched(test::cube(-0.5, 0.5), {2, 3, 1.5}));
  EXPECT_DOUBLE_EQ(d.length, 3);
  EXPECT_DOUBLE_EQ(d.width, 2);
  EXPECT_DOUBLE_EQ(d.thickness, 1.5);
  EXPECT_DOUBLE_EQ(d.elongation, 2.0 / 3);
  EXPECT_DOUBLE_EQ(d.flatness, 0.75);
  EXPECT_DOUBLE_EQ(d.surface_area, 27);
  EXPECT_NEAR(d.sphericity, std::cbrt(std::numbers::pi) * std::pow(6 * 9, 2.0 / 3) / 27, 1e-12);
  EXPECT_NEAR(d.convexity, 1, 1e-5);
  EXPECT_LT(d.roundness, 0.4) << "edges are corners";
}

// Corners of an ellipsoid of revolution are where its sharper radius is below the inscribed one.
TEST(ShapeDescriptors, RoundnessOfAProlateEllipsoidMatchesItsCurvature) {
  const double a = 1.5;  // half axis of revolution; the other two are 1
  const ShapeDescriptors d = describe(test::stretched(geodesic_sphere(30), {1, 1, a}));
  // Meridian angle t: point (sin t, a cos t), arc length element s = sqrt(cos^2 + a^2 sin^2);
  // radii of curvature: s^3 / a along the meridian, s / a across it; inscribed radius 1.
  double weighted = 0;
  double weight = 0;
  const int steps = 20000;
  for (int n = 0; n < steps; ++n) {
    const double t = std::numbers::pi * (n + 0.5) / steps;
    const double s = std::sqrt(std::cos(t) * std::cos(t) + a * a * std::sin(t) * std::sin(t));
    const double sharper = std::min(s * s * s / a, s / a);
    const double element = std::sin(t) * s * corner_weight(sharper);
    weighted += sharper * element;
    weight += element;
  }
  EXPECT_NEAR(d.roundness, weighted / weight, 0.05);
}

// A cylinder's side has the radius r; the inscribed radius reaches it at a length of 2 r. The side
// is no corner on either side of that length.
TEST(ShapeDescriptors, RoundnessOfACylinderDoesNotJump) {
  double last = 0;
  for (const double half_length : {0.9, 0.95, 0.975, 1.0, 1.025, 1.05, 1.2}) {
    const double roundness =
        describe(to_principal_frame(cylinder_mesh(1, half_length, 0.05))).roundness;
    EXPECT_LT(roundness, 0.4) << "its edges are sharp";
    if (last > 0) {
      EXPECT_NEAR(roundness, last, 0.03) << half_length;
    }
    last = roundness;
  }
}

TEST(InscribedRadius, IsFoundOffTheGridAndOffTheCentre) {
  RandomStream random{8, RandomPurpose::other, 0};
  for (int trial = 0; trial < 5; ++trial) {
    TriangleMesh mesh = test::stretched(geodesic_sphere(10), {1, 0.8, 0.9});
    const Vec3 shift{random.uniform(), random.uniform(), random.uniform()};
    for (Vec3& v : mesh.vertices) v += shift;
    const TriangleBvh bvh{mesh};
    EXPECT_NEAR(inscribed_radius(bvh, sample_signed_distance(bvh, 0.17)), 0.8, 0.01);
  }
  const TriangleMesh corner = test::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const TriangleBvh bvh{corner};
  EXPECT_NEAR(inscribed_radius(bvh, sample_signed_distance(bvh, 0.07)), 1 / (3 + std::sqrt(3)),
              3e-4);
}

}  // namespace
}  // namespace reckon
