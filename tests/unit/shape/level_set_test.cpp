// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/shape/level_set.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "reckon/core/random.hpp"

namespace reckon {
namespace {

/// Any trilinear function of space; with values like these all vertex values are exact floats.
struct Trilinear {
  double constant, x, y, z, xy, xz, yz, xyz;
  [[nodiscard]] double value(const Vec3& p) const {
    return constant + x * p.x + y * p.y + z * p.z + xy * p.x * p.y + xz * p.x * p.z +
           yz * p.y * p.z + xyz * p.x * p.y * p.z;
  }
  [[nodiscard]] Vec3 gradient(const Vec3& p) const {
    return {x + xy * p.y + xz * p.z + xyz * p.y * p.z, y + xy * p.x + yz * p.z + xyz * p.x * p.z,
            z + xz * p.x + yz * p.y + xyz * p.x * p.y};
  }
};
constexpr Trilinear field{0.5, 1, -2, 0.75, 0.25, -0.5, 1.5, 0.125};

template <class Function>
LevelSet make_grid(std::array<std::int32_t, 3> dims, double spacing, const Vec3& origin,
                   Function&& function) {
  LevelSet grid{dims, spacing, origin, {}};
  for (std::int32_t k = 0; k < dims[2]; ++k) {
    for (std::int32_t j = 0; j < dims[1]; ++j) {
      for (std::int32_t i = 0; i < dims[0]; ++i) {
        grid.values.push_back(static_cast<float>(function(grid.vertex_body(i, j, k))));
      }
    }
  }
  return grid;
}

Vec3 random_point(RandomStream& random, const Vec3& low, const Vec3& high) {
  const double x = random.uniform(low.x, high.x);
  const double y = random.uniform(low.y, high.y);
  const double z = random.uniform(low.z, high.z);
  return {x, y, z};
}

TEST(LevelSet, TrilinearFieldsComeBackExactlyWithTheirGradients) {
  const LevelSet grid =
      make_grid({5, 4, 6}, 0.5, {-1, -0.5, 2}, [](const Vec3& p) { return field.value(p); });
  const LevelSetView view{grid};
  RandomStream random{1, RandomPurpose::other, 0};
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p = random_point(random, {-1, -0.5, 2}, {1, 1, 4.5});
    const auto sample = view.sample(p);
    ASSERT_TRUE(sample.inside_grid);
    EXPECT_NEAR(sample.phi, field.value(p), 1e-13);
    EXPECT_NEAR(norm(sample.gradient_body - field.gradient(p)), 0, 1e-12);
  }
}

TEST(LevelSet, TheGradientIsThatOfTheInterpolantOnAnyField) {
  RandomStream random{2, RandomPurpose::other, 0};
  const LevelSet grid =
      make_grid({4, 4, 4}, 0.1, {0, 0, 0}, [&](const Vec3&) { return random.uniform(-1, 1); });
  const LevelSetView view{grid};
  for (int n = 0; n < 300; ++n) {
    Vec3 p = random_point(random, {0.01, 0.01, 0.01}, {0.29, 0.29, 0.29});
    const Vec3 gradient = view.sample(p).gradient_body;
    const auto here = view.locate(p);
    const double step = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 ahead = p;
      ahead[axis] += step;
      Vec3 behind = p;
      behind[axis] -= step;
      const auto a = view.locate(ahead);
      const auto b = view.locate(behind);
      if (a.i != here.i || a.j != here.j || a.k != here.k) continue;
      if (b.i != here.i || b.j != here.j || b.k != here.k) continue;
      EXPECT_NEAR((view.sample(ahead).phi - view.sample(behind).phi) / (2 * step), gradient[axis],
                  1e-6);
    }
  }
}

TEST(LevelSet, VerticesAndTheLastLayerBelongToTheGrid) {
  const LevelSet grid =
      make_grid({3, 4, 5}, 0.25, {1, 2, 3}, [](const Vec3& p) { return field.value(p); });
  const LevelSetView view{grid};
  for (std::int32_t k = 0; k < 5; ++k) {
    for (std::int32_t j = 0; j < 4; ++j) {
      for (std::int32_t i = 0; i < 3; ++i) {
        const auto sample = view.sample(grid.vertex_body(i, j, k));
        ASSERT_TRUE(sample.inside_grid);
        EXPECT_EQ(sample.phi, grid.values[grid.index(i, j, k)]);
      }
    }
  }
  const Vec3 last = grid.vertex_body(2, 3, 4);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double outside :
         {std::nextafter(last[axis], infinity), std::nextafter(grid.origin_body[axis], -infinity),
          nan, infinity, -infinity, 1e300}) {
      Vec3 p = last;
      p[axis] = outside;
      EXPECT_FALSE(view.sample(p).inside_grid) << axis << ' ' << outside;
    }
  }
}

TEST(LevelSet, LipschitzConstantBoundsTheDistanceToTheInsideAndIsReached) {
  RandomStream random{3, RandomPurpose::other, 0};
  const LevelSet noise =
      make_grid({6, 5, 4}, 0.2, {0, 0, 0}, [&](const Vec3&) { return random.uniform(-1, 1); });
  const LevelSetView view{noise};
  const double bound = lipschitz_constant(noise);
  double steepest = 0;
  int crossings = 0;
  for (int n = 0; n < 200000; ++n) {
    const Vec3 a = random_point(random, {0, 0, 0}, {1, 0.8, 0.6});
    const Vec3 b = a + random_point(random, {-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3});
    if (view.sample(a).phi < 0) continue;
    steepest = std::max(steepest, norm(view.sample(a).gradient_body));
    if (!view.locate(b).inside || view.sample(b).phi >= 0) continue;
    ASSERT_LE(view.sample(a).phi, bound * norm(a - b) + 1e-14);
    ++crossings;
  }
  EXPECT_GT(crossings, 10000);
  EXPECT_LE(steepest, bound * (1 + 1e-12));
  EXPECT_GT(steepest, 0.8 * bound);
  const LevelSet plane = make_grid({4, 4, 4}, 0.5, {0, 0, 0},
                                   [](const Vec3& p) { return 0.5 * p.x - 0.25 * p.y + p.z; });
  EXPECT_NEAR(lipschitz_constant(plane), norm(Vec3{0.5, 0.25, 1}), 1e-14);
}

}  // namespace
}  // namespace reckon
