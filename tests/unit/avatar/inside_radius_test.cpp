// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/inside_radius.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grids.hpp"
#include "reckon/core/random.hpp"

namespace reckon {
namespace {

/// The farthest point with phi < 0 among many.
double farthest_found(const LevelSet& grid, RandomStream& random, int trials) {
  const LevelSetView view{grid};
  double farthest = 0;
  for (int n = 0; n < trials; ++n) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = grid.spacing * (grid.dims[static_cast<std::size_t>(axis)] - 1);
      p[axis] = grid.origin_body[axis] + extent * random.uniform();
    }
    const auto sample = view.sample(p);
    if (sample.inside_grid && sample.phi < 0) farthest = std::max(farthest, norm(p));
  }
  return farthest;
}

TEST(InsideRadius, NothingInsideLiesFartherAndLittleIsWasted) {
  RandomStream random{5, RandomPurpose::other, 0};
  for (int trial = 0; trial < 5; ++trial) {
    const LevelSet grid = test::cube_grid(1, 12, {0.01, 0.02, 0.03}, [&](const Vec3& p) {
      return norm(hadamard(p, {1, 1.5, 2})) - 0.8 + random.uniform(-0.1, 0.1);
    });
    const double radius = inside_radius(grid);
    const double found = farthest_found(grid, random, 2000000);
    EXPECT_LE(found, radius);
    EXPECT_LT(radius - found, 0.15 * grid.spacing);
  }
}

TEST(InsideRadius, NoisyGridsNeverReachBeyondIt) {
  RandomStream random{6, RandomPurpose::other, 0};
  for (int trial = 0; trial < 20; ++trial) {
    const LevelSet grid =
        test::cube_grid(1, 3, {}, [&](const Vec3&) { return random.uniform(-0.2, 1); });
    EXPECT_LE(farthest_found(grid, random, 100000), inside_radius(grid));
  }
}

TEST(InsideRadius, StartsFromWhatItIsGiven) {
  const LevelSet grid = test::cube_grid(1.3, 30, {}, test::sphere_distance(1));
  EXPECT_NEAR(inside_radius(grid), 1, 0.01);
  EXPECT_NEAR(inside_radius(grid, 1.2), 1.2, 1e-9);
}

}  // namespace
}  // namespace reckon
