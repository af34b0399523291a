// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/distance_transform.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "grids.hpp"
#include "reckon/avatar/closest_triangles.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/shape_builder.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

/// How far the transform is from a search of the tree at each vertex [spacings].
struct Difference {
  double largest_excess{0};
  double mean_excess{0};
  std::size_t too_small{0};
  std::size_t wrong_side{0};
  std::size_t not_exact{0};  // in the band, to the last bit
};

Difference compare(const TriangleMesh& mesh, double spacing) {
  const TriangleBvh bvh{mesh};
  const LevelSet exact = sample_signed_distance(bvh, spacing);
  const LevelSet found = transformed_distance(mesh, bvh, spacing);
  EXPECT_EQ(found.dims, exact.dims);
  EXPECT_EQ(found.spacing, exact.spacing);
  EXPECT_EQ(found.origin_body, exact.origin_body);
  Difference d;
  for (std::size_t v = 0; v < exact.values.size(); ++v) {
    const double distance = std::abs(double{exact.values[v]});
    const double excess = (std::abs(double{found.values[v]}) - distance) / spacing;
    d.largest_excess = std::max(d.largest_excess, excess);
    d.mean_excess += excess / static_cast<double>(exact.values.size());
    d.too_small += excess < -1e-6 ? 1U : 0U;
    d.wrong_side += std::signbit(found.values[v]) != std::signbit(exact.values[v]) ? 1U : 0U;
    const bool in_band = distance < (exact_band - 1e-6) * spacing;
    d.not_exact += in_band && found.values[v] != exact.values[v] ? 1U : 0U;
  }
  // What the contact filter divides by must not suffer.
  EXPECT_LE(lipschitz_constant(found), 1.1 * lipschitz_constant(exact));
  return d;
}

TriangleMesh lumpy_star() {
  TriangleMesh star = geodesic_sphere(24);
  for (Vec3& v : star.vertices) {
    v *= 1 + 0.25 * std::sin(4 * v.x + 1) * std::cos(5 * v.y) + 0.1 * std::sin(9 * v.z);
  }
  return star;
}

struct Case {
  const char* name;
  TriangleMesh mesh;
  double spacing;
};

/// Smooth, with edges, thin, with thin triangles, with a notch.
std::vector<Case> cases() {
  const TriangleMesh sphere = geodesic_sphere(16);
  return {{"sphere", sphere, 0.083},
          {"flat ellipsoid", test::stretched(sphere, {1, 0.7, 0.3}), 0.05},
          {"box of twelve triangles", test::stretched(test::cube(), {1, 0.8, 0.6}), 0.031},
          {"plate", test::stretched(test::cube(), {1, 0.9, 0.1}), 0.04},
          {"star", lumpy_star(), 0.06},
          {"star on a coarse grid", lumpy_star(), 0.2}};
}

TEST(DistanceTransform, EqualsTheSearchNearTheSurfaceAndNearlySoBeyond) {
  for (const auto& [name, mesh, spacing] : cases()) {
    SCOPED_TRACE(name);
    const Difference d = compare(mesh, spacing);
    EXPECT_EQ(d.not_exact, 0U);
    EXPECT_EQ(d.wrong_side, 0U);
    EXPECT_EQ(d.too_small, 0U);
    EXPECT_LT(d.largest_excess, 0.2);
    EXPECT_LT(d.mean_excess, 0.01);
    RecordProperty(std::string{name} + ": largest excess", std::to_string(d.largest_excess));
    RecordProperty(std::string{name} + ": mean excess", std::to_string(d.mean_excess));
  }
}

TEST(DistanceTransform, OfABandComputesWhatTheBandKeeps) {
  const std::vector<Case> all = cases();
  for (const auto& [name, mesh, spacing] : {all[0], all[3], all[5]}) {
    SCOPED_TRACE(name);
    const TriangleBvh bvh{mesh};
    const LevelSet exact = sample_signed_distance(bvh, spacing);
    const LevelSet found = transformed_distance(mesh, bvh, spacing, ShapeStorage::band);
    const double width = band_half_width * spacing;
    std::size_t not_exact = 0;
    std::size_t not_outside = 0;
    double least_excess = 0;
    double largest_excess = 0;
    for (std::size_t v = 0; v < exact.values.size(); ++v) {
      const double phi = exact.values[v];
      if (std::abs(phi) < (1 - 1e-6) * width) {
        not_exact += found.values[v] != exact.values[v] ? 1U : 0U;
      } else if (phi > 0) {
        not_outside += std::abs(found.values[v] - width) > 1e-5 * width ? 1U : 0U;
      } else {
        const double excess = (phi - double{found.values[v]}) / spacing;
        least_excess = std::min(least_excess, excess);
        largest_excess = std::max(largest_excess, excess);
      }
    }
    EXPECT_EQ(not_exact, 0U);
    EXPECT_EQ(not_outside, 0U);
    EXPECT_GT(least_excess, -1e-4);
    EXPECT_LT(largest_excess, 0.2);
    RecordProperty(std::string{name} + ": largest excess", std::to_string(largest_excess));
  }
}

/// Cones of normals that exclude nothing: triangles without area, and two sheets back to back.
TEST(ClosestTriangles, AreFoundBesideTrianglesThatTellNothing) {
  TriangleMesh mesh = test::stretched(test::cube(), {1, 0.8, 0.02});
  const auto corner = mesh.triangles.front();
  mesh.triangles.push_back({corner[0], corner[1], corner[1]});
  const TriangleBvh bvh{mesh};
  const double spacing = 0.05;
  const LevelSet grid = grid_around(bvh.bounds(), spacing);
  const double reach = 1.9 * spacing;
  const std::vector<std::uint32_t> found = closest_triangles(mesh, grid, reach);
  std::size_t wrong = 0;
  for (std::int32_t k = 0; k < grid.dims[2]; ++k) {
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      for (std::int32_t i = 0; i < grid.dims[0]; ++i) {
        const Vec3 vertex = grid.vertex_body(i, j, k);
        const double squared = bvh.closest_point(vertex).squared_distance;
        const std::uint32_t t = found[grid.index(i, j, k)];
        if (t == no_triangle) {
          wrong += squared < 0.999 * reach * reach ? 1U : 0U;
          continue;
        }
        const auto& c = mesh.triangles[t];
        const ClosestPoint closest = closest_point_on_triangle(
            vertex, mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]);
        wrong += closest.squared_distance != squared ? 1U : 0U;
      }
    }
  }
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace reckon
