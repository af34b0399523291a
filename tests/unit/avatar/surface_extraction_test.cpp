// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/surface_extraction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "expect_error.hpp"
#include "grids.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/core/random.hpp"

namespace reckon {
namespace {

using std::numbers::pi;

/// Every directed side of a triangle is met exactly once by the opposite side of another.
void expect_watertight(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
  for (const auto& t : mesh.triangles) {
    for (std::size_t s = 0; s < 3; ++s) ++sides[{t[s], t[(s + 1) % 3]}];
  }
  for (const auto& [side, count] : sides) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(sides.contains({side.second, side.first}));
  }
}

TEST(SurfaceExtraction, SphereConvergesWithTheSquareOfTheSpacing) {
  std::vector<double> volume_error;
  std::vector<double> area_error;
  for (const std::int32_t cells : {20, 40}) {
    const LevelSet grid =
        test::cube_grid(1.3, cells, {0.011, -0.007, 0.003}, test::sphere_distance(1));
    const TriangleMesh mesh = extract_surface(grid);
    expect_watertight(mesh);
    const SolidProperties solid = solid_properties(mesh);
    volume_error.push_back(1 - solid.volume / (4 * pi / 3));
    area_error.push_back(1 - solid.surface_area / (4 * pi));
  }
  EXPECT_GT(volume_error[1], 0) << "a chord surface lies inside";
  EXPECT_NEAR(std::log2(volume_error[0] / volume_error[1]), 2, 0.15);
  EXPECT_NEAR(std::log2(area_error[0] / area_error[1]), 2, 0.25);
  EXPECT_LT(volume_error[1], 0.005);
}

// Random values have every case of a cell, ambiguous faces included, many times over.
TEST(SurfaceExtraction, NoiseGivesAWatertightSurfaceThatSeparatesTheSigns) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random{seed, RandomPurpose::other, 0};
    constexpr std::int32_t cells = 10;
    LevelSet grid = test::cube_grid(1, cells, {}, [&](const Vec3& p) {
      const double margin = 1 - std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
      const double value = random.uniform(-1, 1);
      if (margin < 0.01) return 1.0;
      return seed % 2 == 0 ? value : std::round(2 * value) / 2;  // odd seeds: many exact zeros
    });
    const TriangleMesh mesh = extract_surface(grid);
    ASSERT_GT(mesh.triangles.size(), 1000U);
    expect_watertight(mesh);
    for (const auto& t : mesh.triangles) {
      ASSERT_GT(norm(cross(mesh.vertices[t[1]] - mesh.vertices[t[0]],
                           mesh.vertices[t[2]] - mesh.vertices[t[0]])),
                0);
    }
    // The winding number (solid angle over 4 pi) of the mesh about a grid vertex is one inside.
    for (std::int32_t k = 1; k < cells; k += 3) {
      for (std::int32_t j = 1; j < cells; j += 2) {
        const std::int32_t i = 1 + (j + k) % (cells - 1);
        const Vec3 q = grid.vertex_body(i, j, k);
        double angle = 0;
        for (const auto& t : mesh.triangles) {
          const Vec3 a = mesh.vertices[t[0]] - q;
          const Vec3 b = mesh.vertices[t[1]] - q;
          const Vec3 c = mesh.vertices[t[2]] - q;
          angle += 2 * std::atan2(dot(a, cross(b, c)),
                                  norm(a) * norm(b) * norm(c) + dot(a, b) * norm(c) +
                                      dot(b, c) * norm(a) + dot(c, a) * norm(b));
        }
        const double inside = grid.values[grid.index(i, j, k)] < 0 ? 1 : 0;
        ASSERT_NEAR(angle / (4 * pi), inside, 1e-6);
      }
    }
  }
}

TEST(SurfaceExtraction, RefusesAGrainThatReachesTheEdgeOfItsGrid) {
  const LevelSet grid = test::cube_grid(1, 10, {}, test::sphere_distance(1.05));
  test::expect_error([&] { (void)extract_surface(grid); }, {"open", "edge of its grid"});
}

}  // namespace
}  // namespace reckon
