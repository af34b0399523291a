// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/grid_mass.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "grids.hpp"
#include "reckon/core/random.hpp"

namespace reckon {
namespace {

using std::numbers::pi;

TEST(GridMass, SmoothedCountingOfASphereIsFarBetterThanPlainCounting) {
  RandomStream random{1, RandomPurpose::other, 0};
  double worst_volume = 0;
  double worst_area = 0;
  double worst_inertia = 0;
  double worst_plain = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const double h = 0.2;  // ten voxels per diameter
    const Vec3 center{h * random.uniform(), h * random.uniform(), h * random.uniform()};
    const LevelSet grid =
        test::cube_grid(1.6, 16, {}, [&](const Vec3& p) { return norm(p - center) - 1; });
    const SolidProperties found = grid_properties(grid);
    worst_volume = std::max(worst_volume, std::abs(found.volume / (4 * pi / 3) - 1));
    worst_area = std::max(worst_area, std::abs(found.surface_area / (4 * pi) - 1));
    worst_inertia = std::max(worst_inertia, std::abs(found.inertia.row_x.x / (8 * pi / 15) - 1));
    worst_plain = std::max(worst_plain, std::abs(plain_grid_volume(grid) / (4 * pi / 3) - 1));
    EXPECT_NEAR(norm(found.centroid - center), 0, 2e-3 * h);
    EXPECT_NEAR(found.inertia.row_x.y, 0, 1e-4);
    EXPECT_NEAR(found.inertia.row_y.z, 0, 1e-4);
  }
  EXPECT_LT(worst_volume, 2e-4);
  EXPECT_LT(worst_area, 5e-3);
  EXPECT_LT(worst_inertia, 2e-3);
  EXPECT_GT(worst_plain, 5e-3);
}

// Edges and corners bend the distance: second order is left.
TEST(GridMass, BoxConvergesWithTheSquareOfTheSpacing) {
  const Vec3 half{0.9, 0.7, 0.5};
  const auto box_distance = [&](const Vec3& p) {
    const Vec3 d{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
    const Vec3 out{std::max(d.x, 0.0), std::max(d.y, 0.0), std::max(d.z, 0.0)};
    return norm(out) + std::min(0.0, std::max({d.x, d.y, d.z}));
  };
  std::vector<double> error;
  for (const std::int32_t cells : {25, 50, 100}) {
    const LevelSet grid = test::cube_grid(1.25, cells, {0.013, 0.007, -0.003}, box_distance);
    error.push_back(std::abs(grid_properties(grid).volume / (8 * half.x * half.y * half.z) - 1));
  }
  EXPECT_LT(error[0], 0.01);
  EXPECT_GT(std::log2(error[0] / error[2]) / 2, 1.8);
}

TEST(GridMass, OffDiagonalInertiaHasTheSignOfATensor) {
  // Two small spheres along (1, 1, 0): more mass away from the z axis; I_xy < 0.
  const LevelSet grid = test::cube_grid(2, 40, {}, [](const Vec3& p) {
    return std::min(norm(p - Vec3{0.9, 0.9, 0}), norm(p + Vec3{0.9, 0.9, 0})) - 0.5;
  });
  const SolidProperties found = grid_properties(grid);
  const double sphere = pi / 6;
  EXPECT_NEAR(found.volume, 2 * sphere, 1e-3);
  EXPECT_NEAR(found.inertia.row_x.y, -2 * sphere * 0.81, 2e-3);
  EXPECT_EQ(found.inertia.row_x.y, found.inertia.row_y.x);
  EXPECT_NEAR(found.inertia.row_z.z, 2 * sphere * (0.1 + 1.62), 5e-3);
}

}  // namespace
}  // namespace reckon
