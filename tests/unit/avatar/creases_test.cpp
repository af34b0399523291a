// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/creases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/curved_surface.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

using std::numbers::pi;

TEST(Creases, AreTheEdgesOfABoxTheRimsOfACylinderAndNothingOnASphere) {
  const TriangleMesh box = box_mesh({1, 0.7, 0.5}, 0.1);
  const std::vector<Crease> edges = creases_of(box);
  ASSERT_EQ(edges.size(), 12U);
  double length = 0;
  for (const Crease& edge : edges) {
    EXPECT_FALSE(edge.closed);
    const std::vector<Vec3> line = line_along(box, edge);
    length += norm(line.back() - line.front());
    for (const Vec3& end : {line.front(), line.back()}) {
      EXPECT_EQ(std::abs(end.x), 1);
      EXPECT_EQ(std::abs(end.y), 0.7);
      EXPECT_EQ(std::abs(end.z), 0.5);
    }
  }
  EXPECT_NEAR(length, 8 * (1 + 0.7 + 0.5), 1e-12);

  const std::vector<Crease> rims = creases_of(cylinder_mesh(1, 2, 0.1));
  ASSERT_EQ(rims.size(), 2U);
  EXPECT_TRUE(rims[0].closed && rims[1].closed);
  EXPECT_TRUE(creases_of(geodesic_sphere(6)).empty());
}

TEST(PointsOnCreases, KeepCornersAndAreEvenBetweenThem) {
  const TriangleMesh box = box_mesh({1, 0.7, 0.5}, 0.3);
  const std::vector<Vec3> points = points_on_creases(box, creases_of(box), 0.25);
  // 2 / 0.25, 1.4 / 0.25 and 1 / 0.25 pieces to an edge, and eight corners once each.
  EXPECT_EQ(points.size(), 8U + 4 * (7 + 5 + 3));
  int corners = 0;
  for (const Vec3& p : points) {
    const bool at_x = std::abs(p.x) == 1;
    const bool at_y = std::abs(p.y) == 0.7;
    const bool at_z = std::abs(p.z) == 0.5;
    EXPECT_GE(int{at_x} + int{at_y} + int{at_z}, 2);
    corners += at_x && at_y && at_z ? 1 : 0;
  }
  EXPECT_EQ(corners, 8);
  EXPECT_TRUE(points_on_creases(box, creases_of(box), 5).empty());

  const TriangleMesh cylinder = cylinder_mesh(1, 2, 0.01);
  EXPECT_EQ(points_on_creases(cylinder, creases_of(cylinder), 2 * pi / 20).size(), 40U);
}

TEST(CurvedSurface, LiesOnTheSphereWhoseChordsTheMeshIs) {
  double before = 1;
  for (const std::uint32_t frequency : {8U, 16U}) {
    const TriangleMesh mesh = geodesic_sphere(frequency);
    const TriangleBvh bvh{mesh};
    const CurvedSurface surface{mesh};
    double worst = 0;
    double chord = 0;
    for (int n = 0; n < 500; ++n) {
      const Vec3 ray = normalized(Vec3{std::sin(1.1 * n), std::cos(2.3 * n), std::sin(3.7 * n)});
      const ClosestPoint on_mesh = bvh.closest_point(ray);
      worst = std::max(worst, std::abs(norm(surface.point(on_mesh)) - 1));
      chord = std::max(chord, std::abs(norm(on_mesh.point) - 1));
      EXPECT_GT(dot(surface.normal(on_mesh), ray), 1 - 1e-4);
    }
    EXPECT_LT(worst, 0.02 * chord) << frequency;
    // Third order or better, where chords have second.
    EXPECT_LT(worst, 0.15 * before);
    before = worst;
  }
}

TEST(CurvedSurface, LeavesFlatFacesFlatUpToTheirEdges) {
  const TriangleMesh box = box_mesh({1, 0.7, 0.5}, 0.3);
  const TriangleBvh bvh{box};
  const CurvedSurface surface{box};
  for (int n = 0; n < 300; ++n) {
    const ClosestPoint on_box =
        bvh.closest_point({1.2 * std::sin(1.1 * n), std::cos(2.3 * n), std::sin(3.7 * n)});
    EXPECT_LT(norm(surface.point(on_box) - on_box.point), 1e-14);
  }
}

}  // namespace
}  // namespace reckon
