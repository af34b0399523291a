// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/surface_nodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "grids.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

struct Evenness {
  double spacing_variation{0};  // of the distance to the nearest other point: deviation / mean
  double area_variation{0};
  double least_spacing{0};  // over the mean
};

double variation(const std::vector<double>& values) {
  double mean = 0;
  double squares = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) {
    squares += (v - mean) * (v - mean) / static_cast<double>(values.size());
  }
  return std::sqrt(squares) / mean;
}

Evenness evenness(const TriangleMesh& mesh, std::size_t count) {
  const TriangleBvh bvh{mesh};
  const std::vector<std::uint32_t> order = bvh.tree_order();
  const OrientedPoints points = spread_points({mesh, order}, bvh, count);
  EXPECT_EQ(points.size(), count);
  std::vector<double> nearest(count, std::numeric_limits<double>::infinity());
  double mean = 0;
  for (std::size_t a = 0; a < count; ++a) {
    EXPECT_LT(std::abs(bvh.signed_distance(points.position[a])), 1e-12);
    for (std::size_t b = 0; b < count; ++b) {
      if (a == b) continue;
      nearest[a] = std::min(nearest[a], norm(points.position[a] - points.position[b]));
    }
    mean += nearest[a] / static_cast<double>(count);
  }
  const auto areas = tributary_areas(points, sample_surface(mesh, 400 * count), 1);
  return {variation(nearest), variation(areas),
          *std::min_element(nearest.begin(), nearest.end()) / mean};
}

TEST(SpreadPoints, AreEvenOnSmoothAndOnSharpGrains) {
  const TriangleMesh sphere = geodesic_sphere(20);
  const TriangleMesh cube = test::cube();
  const struct {
    const char* name;
    TriangleMesh mesh;
  } cases[] = {{"sphere", sphere},
               {"ellipsoid", test::stretched(sphere, {1, 0.6, 0.3})},
               {"box", test::stretched(cube, {1, 0.7, 0.5})},
               {"plate", test::stretched(cube, {1, 0.8, 0.15})}};
  for (const auto& [name, mesh] : cases) {
    for (const std::size_t count : {100UL, 279UL, 1000UL}) {
      const Evenness found = evenness(mesh, count);
      // A perfect hexagonal pattern has 0; random points have about 0.5 and 0.5.
      EXPECT_LT(found.spacing_variation, 0.11) << name << ' ' << count;
      EXPECT_LT(found.area_variation, 0.15) << name << ' ' << count;
      EXPECT_GT(found.least_spacing, 0.6) << name << ' ' << count;
      RecordProperty(std::string{name} + "_" + std::to_string(count) + "_spacing_variation",
                     std::to_string(found.spacing_variation));
      RecordProperty(std::string{name} + "_" + std::to_string(count) + "_area_variation",
                     std::to_string(found.area_variation));
    }
  }
}

TEST(SampleSurface, EqualSharesIntegrateFunctionsOverTheSurface) {
  const TriangleMesh cube = test::cube(-1, 1);
  const OrientedPoints samples = sample_surface(cube, 20000);
  ASSERT_EQ(samples.size(), 20000U);
  double first = 0;
  double second = 0;
  double flux = 0;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const Vec3& p = samples.position[s];
    first += p.x / 20000;
    second += p.x * p.x / 20000;
    flux += dot(p, samples.normal[s]) / 20000;
  }
  EXPECT_NEAR(first, 0, 1e-3);
  EXPECT_NEAR(second, (2.0 * 1 + 4.0 / 3) / 6, 1e-3);  // two faces at |x| = 1, four with mean 1/3
  EXPECT_NEAR(flux, 1, 1e-12);
}

TEST(TributaryAreas, TwoPolesShareASphereAndAThinPlateKeepsItsSidesApart) {
  const OrientedPoints samples = sample_surface(geodesic_sphere(20), 40000);
  const OrientedPoints poles{{{0, 0, 1}, {0, 0, -1}}, {{0, 0, 1}, {0, 0, -1}}};
  const auto half = tributary_areas(poles, samples, 4 * std::numbers::pi);
  EXPECT_NEAR(half[0], 2 * std::numbers::pi, 0.02);
  EXPECT_DOUBLE_EQ(half[0] + half[1], 4 * std::numbers::pi);

  // Four points above and one below a plate a thousandth thick: without the normals, the one below
  // would only get what is nearest to the plate's middle.
  const TriangleMesh plate = test::stretched(test::cube(-1, 1), {1, 1, 1e-3});
  OrientedPoints points;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      points.position.push_back({x, y, 1e-3});
      points.normal.push_back({0, 0, 1});
    }
  }
  points.position.push_back({0, 0, -1e-3});
  points.normal.push_back({0, 0, -1});
  const auto areas = tributary_areas(points, sample_surface(plate, 40000), 8);
  for (int n = 0; n < 4; ++n) EXPECT_NEAR(areas[static_cast<std::size_t>(n)], 1, 0.02);
  EXPECT_NEAR(areas[4], 4, 0.03);
}

TEST(TributaryAreas, AreTheSameWhetherSamplesAreKeptOrNot) {
  const TriangleMesh mesh = test::stretched(geodesic_sphere(20), {1, 0.6, 0.3});
  const TriangleBvh bvh{mesh};
  const std::vector<std::uint32_t> order = bvh.tree_order();
  const SurfaceSampler sampler{mesh, order};
  const OrientedPoints points = spread_points(sampler, bvh, 150);
  const OrientedPoints samples = sample_surface(sampler, 20000);
  EXPECT_EQ(tributary_areas(points, samples, sampler.area()),
            tributary_areas(points, sampler, samples.size()));
  // And are those of the nearest points, found one by one.
  std::vector<double> share(points.size(), 0);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    std::size_t best = 0;
    for (std::size_t n = 1; n < points.size(); ++n) {
      if (squared_norm(points.position[n] - samples.position[s]) <
          squared_norm(points.position[best] - samples.position[s])) {
        best = n;
      }
    }
    share[best] += sampler.area() / 20000;
  }
  const auto areas = tributary_areas(points, sampler, samples.size());
  for (std::size_t n = 0; n < share.size(); ++n) EXPECT_NEAR(areas[n] / share[n], 1, 1e-9);
}

}  // namespace
}  // namespace reckon
