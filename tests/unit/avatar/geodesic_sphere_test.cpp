// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/geodesic_sphere.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reckon/avatar/half_edges.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/core/error.hpp"

namespace reckon {
namespace {

class GeodesicSphere : public testing::TestWithParam<GeodesicBase> {};

TEST_P(GeodesicSphere, IsClosedAndOnTheSphere) {
  const std::size_t faces = GetParam() == GeodesicBase::icosahedron ? 20 : 8;
  for (const std::uint32_t n : {1U, 2U, 3U, 10U}) {
    const TriangleMesh mesh = geodesic_sphere(n, GetParam());
    EXPECT_EQ(mesh.triangles.size(), faces * n * n);
    EXPECT_EQ(mesh.vertices.size(), faces * n * n / 2 + 2);  // Euler's formula
    for (const Vec3& v : mesh.vertices) ASSERT_NEAR(norm(v), 1, 3e-16);
    const auto edges = sorted_half_edges(mesh);
    for (std::size_t e = 0; e < edges.size(); e += 2) {
      ASSERT_TRUE(edges[e].same_edge(edges[e + 1]));
      ASSERT_NE(edges[e].ascending, edges[e + 1].ascending);
    }
    EXPECT_GT(solid_properties(mesh).volume, 0);
  }
}

TEST_P(GeodesicSphere, VolumeAndAreaConvergeAtSecondOrder) {
  double previous_volume = 0;
  double previous_area = 0;
  for (const std::uint32_t n : {8U, 16U, 32U}) {
    const SolidProperties solid = solid_properties(geodesic_sphere(n, GetParam()));
    const double volume_error = 1 - solid.volume / (4 * std::numbers::pi / 3);
    const double area_error = 1 - solid.surface_area / (4 * std::numbers::pi);
    EXPECT_GT(volume_error, 0);
    if (n > 8) {
      EXPECT_NEAR(std::log2(previous_volume / volume_error), 2, 0.03);
      EXPECT_NEAR(std::log2(previous_area / area_error), 2, 0.03);
    }
    previous_volume = volume_error;
    previous_area = area_error;
  }
}

TEST_P(GeodesicSphere, FrequencyMeetsTheTargetEdge) {
  for (const double edge : {0.5, 0.11, 0.03}) {
    const std::uint32_t n = geodesic_frequency(2, edge, GetParam());
    const auto mean_edge = [&](std::uint32_t frequency) {
      const TriangleMesh mesh = geodesic_sphere(frequency, GetParam());
      double sum = 0;
      const auto edges = sorted_half_edges(mesh);
      for (const HalfEdge& e : edges) sum += 2 * norm(mesh.vertices[e.high] - mesh.vertices[e.low]);
      return sum / static_cast<double>(edges.size());
    };
    EXPECT_LT(mean_edge(n), 1.05 * edge);
    EXPECT_GT(mean_edge(n - 1), 0.99 * edge);
  }
}

INSTANTIATE_TEST_SUITE_P(Bases, GeodesicSphere,
                         testing::Values(GeodesicBase::icosahedron, GeodesicBase::octahedron));

TEST(GeodesicSphereLimits, AreChecked) {
  EXPECT_THROW((void)geodesic_sphere(0), Error);
  EXPECT_THROW((void)geodesic_sphere(highest_frequency + 1), Error);
  EXPECT_THROW((void)geodesic_frequency(1, 1e-6), Error);
  EXPECT_THROW((void)geodesic_frequency(1, 0), Error);
  EXPECT_THROW((void)geodesic_frequency(1, -1), Error);
  EXPECT_THROW((void)geodesic_frequency(std::nan(""), 1), Error);
}

}  // namespace
}  // namespace reckon
