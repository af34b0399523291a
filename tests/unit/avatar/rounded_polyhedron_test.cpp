// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/rounded_polyhedron.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/random_variates.hpp"

namespace reckon {
namespace {

std::vector<HalfSpace> box(const Vec3& half) {
  return {{{1, 0, 0}, half.x},  {{-1, 0, 0}, half.x}, {{0, 1, 0}, half.y},
          {{0, -1, 0}, half.y}, {{0, 0, 1}, half.z},  {{0, 0, -1}, half.z}};
}

double area(const std::vector<std::vector<Vec3>>& faces) {
  double sum = 0;
  for (const auto& face : faces) {
    for (std::size_t n = 2; n < face.size(); ++n) {
      sum += 0.5 * norm(cross(face[n - 1] - face[0], face[n] - face[0]));
    }
  }
  return sum;
}

TEST(PolyhedronFaces, OfABoxWithACornerCutOff) {
  std::vector<HalfSpace> half_spaces = box({1, 2, 3});
  EXPECT_EQ(polyhedron_faces(half_spaces).size(), 6U);
  EXPECT_NEAR(area(polyhedron_faces(half_spaces)), 88, 1e-11);
  const double s = 1 / std::sqrt(3.0);
  half_spaces.push_back({{s, s, s}, 5 * s});  // through the three neighbours at distance 1
  EXPECT_EQ(polyhedron_faces(half_spaces).size(), 7U);
  EXPECT_NEAR(area(polyhedron_faces(half_spaces)), 88 - 1.5 + std::sqrt(3.0) / 2, 1e-11);
  half_spaces.push_back({{-1, 0, 0}, -2});  // x >= 2: nothing is left
  EXPECT_TRUE(polyhedron_faces(half_spaces).empty());
}

TEST(InscribedRadius, OfABoxAndOfATetrahedron) {
  EXPECT_NEAR(inscribed_radius(box({3, 2, 1.5})), 1.5, 1e-8);
  // The corner tetrahedron x + y + z <= 1, moved so that it holds the origin: r = 1/(3 + sqrt 3).
  const double s = 1 / std::sqrt(3.0);
  EXPECT_NEAR(
      inscribed_radius(
          {{{-1, 0, 0}, 0.1}, {{0, -1, 0}, 0.1}, {{0, 0, -1}, 0.1}, {{s, s, s}, s * (1 - 0.3)}}),
      1 / (3 + std::sqrt(3.0)), 1e-9);
}

TEST(RoundedPolyhedron, OfACubeHasClosedForms) {
  for (const double r : {0.0, 0.05, 0.4, 0.9}) {
    const RoundedPolyhedron body{box({1, 1, 1}), r};
    EXPECT_NEAR(body.corner_radius(), r, 1e-8);
    EXPECT_NEAR(body.radius({1, 0, 0}), 1, 1e-12);
    EXPECT_NEAR(body.radius(normalized(Vec3{1, 0.05, 0})), norm(Vec3{1, 0.05, 0}), 1e-12);
    EXPECT_NEAR(body.radius(normalized(Vec3{1, 1, 0})), (1 - r) * std::sqrt(2.0) + r, 1e-8);
    EXPECT_NEAR(body.radius(normalized(Vec3{1, 1, -1})), (1 - r) * std::sqrt(3.0) + r, 1e-8);
    // Steiner's formula for a cube of edge a blown up by r.
    const double a = 2 * (1 - r);
    const double volume = a * a * a + 6 * a * a * r + 3 * std::numbers::pi * a * r * r +
                          4 * std::numbers::pi / 3 * r * r * r;
    TriangleMesh mesh = geodesic_sphere(60);
    for (Vec3& v : mesh.vertices) v *= body.radius(v);
    EXPECT_NEAR(solid_properties(mesh).volume / volume, 1, 3e-3) << r;
  }
}

// By construction every point of the surface is one corner radius from the core.
TEST(RoundedPolyhedron, SurfaceKeepsItsDistanceFromTheCore) {
  RandomStream random{1, RandomPurpose::other, 0};
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<HalfSpace> half_spaces = box({2, 2, 2});
    for (int n = 0; n < 12; ++n) {
      half_spaces.push_back({random_direction(random), random.uniform(0.7, 1.2)});
    }
    const RoundedPolyhedron body{half_spaces, 0.5};
    std::vector<HalfSpace> core = half_spaces;
    for (HalfSpace& h : core) h.offset -= body.corner_radius();
    for (int n = 0; n < 60; ++n) {
      const Vec3 direction = random_direction(random);
      const Vec3 point = body.radius(direction) * direction;
      // Dykstra's alternating projections onto the core's half spaces.
      Vec3 at = point;
      std::vector<Vec3> corrections(core.size());
      for (int round = 0; round < 1000; ++round) {
        for (std::size_t h = 0; h < core.size(); ++h) {
          const Vec3 start = at + corrections[h];
          const double excess = dot(core[h].normal, start) - core[h].offset;
          at = excess > 0 ? start - excess * core[h].normal : start;
          corrections[h] = start - at;
        }
      }
      ASSERT_NEAR(norm(point - at), body.corner_radius(), 1e-6);
    }
  }
}

}  // namespace
}  // namespace reckon
