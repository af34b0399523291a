// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/distance_transform.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "grids.hpp"
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

TEST(DistanceTransform, EqualsTheSearchNearTheSurfaceAndNearlySoBeyond) {
  const TriangleMesh sphere = geodesic_sphere(16);
  const struct {
    const char* name;
    TriangleMesh mesh;
    double spacing;
  } cases[] = {{"sphere", sphere, 0.083},
               {"flat ellipsoid", test::stretched(sphere, {1, 0.7, 0.3}), 0.05},
               {"box of twelve triangles", test::stretched(test::cube(), {1, 0.8, 0.6}), 0.031},
               {"plate", test::stretched(test::cube(), {1, 0.9, 0.1}), 0.04},
               {"star", lumpy_star(), 0.06},
               {"star on a coarse grid", lumpy_star(), 0.2}};
  for (const auto& [name, mesh, spacing] : cases) {
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

}  // namespace
}  // namespace reckon
