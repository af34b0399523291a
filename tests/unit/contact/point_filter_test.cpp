// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/point_filter.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <deque>

#include "reckon/contact/clearance.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/random.hpp"
#include "support/band_shape.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

/// Points around a grain, some beyond its grid, with spheres around them; 37 of them, so that
/// vectors are left unfilled at the end.
struct Cloud {
  std::vector<float> x, y, z;
  std::vector<float> radius;  // [cells]

  Cloud(const ShapeView& grain, std::uint64_t seed) {
    RandomStream random{seed, RandomPurpose::other, 3};
    const auto within = [&](double low, double high) {
      return static_cast<float>(random.uniform(low, high));
    };
    const double reach = 1.6 * grain.bounding_radius;
    const double widest = 0.3 * grain.bounding_radius / grain.level_set.spacing;
    for (int n = 0; n < 37; ++n) {
      x.push_back(within(-reach, reach));
      y.push_back(within(-reach, reach));
      z.push_back(within(-reach, reach));
      radius.push_back(n % 5 == 0 ? 0 : within(0, widest));
    }
  }
  [[nodiscard]] FilterPoints points(bool spheres) const {
    return {x.data(), y.data(), z.data(), spheres ? radius.data() : nullptr, x.size()};
  }
};

/// Each seen as a whole and as a band.
std::deque<testing::BandShape> forms() {
  std::deque<testing::BandShape> shapes;
  shapes.emplace_back(testing::sphere(1.0, 200, 16));
  shapes.emplace_back(testing::box({1.2, 1.2, 0.15}, 9, 0.06));
  shapes.emplace_back(testing::bumpy_grain(1e-4, 90, 12));
  shapes.emplace_back(testing::bumpy_grain(400, 1500, 40));
  return shapes;
}

RelativePose some_place(const ShapeView& grain, std::uint64_t seed) {
  RandomStream random{seed, RandomPurpose::other, 4};
  const auto part = [&] { return random.uniform(-1, 1); };
  RelativePose at;
  at.turn = rotation_matrix(normalized(Quaternion{part(), part(), part(), part()}));
  at.shift = 0.7 * grain.bounding_radius * Vec3{part(), part(), part()};
  return at;
}

TEST(PointFilter, EveryLevelGivesTheSameBits) {
  for (const testing::BandShape& shape : forms()) {
    for (const ShapeView& grain : {ShapeView{shape.whole()}, shape.view()}) {
      for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const Cloud cloud{grain, seed};
        const double skin = (seed % 3 == 0 ? 0.02 : 0.4) * grain.bounding_radius;
        const FilterTarget target{grain, some_place(grain, seed), grain.bounding_radius, skin};
        for (const bool spheres : {false, true}) {
          std::array<float, 37> expected{};
          point_filter(SimdLevel::scalar)(target, cloud.points(spheres), expected.data());
          for (const SimdLevel level : simd_levels_here()) {
            std::array<float, 37> found{};
            point_filter(level)(target, cloud.points(spheres), found.data());
            for (std::size_t n = 0; n < found.size(); ++n) {
              ASSERT_EQ(std::bit_cast<std::uint32_t>(found[n]),
                        std::bit_cast<std::uint32_t>(expected[n]))
                  << name_of(level) << ", point " << n << ": " << found[n] << " " << expected[n];
            }
          }
        }
      }
    }
  }
}

/// Against double precision: never above the clearance, and below it by rounding alone.
TEST(PointFilter, BoundsTheClearanceFromBelow) {
  const PointFilter filter = point_filter(SimdLevel::automatic);
  for (const testing::BandShape& shape : forms()) {
    for (const ShapeView& grain : {ShapeView{shape.whole()}, shape.view()}) {
      const double skin = 10 * grain.bounding_radius;  // all are looked up
      const Clearance clearance{grain};
      for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const Cloud cloud{grain, seed};
        const RelativePose at = some_place(grain, seed);
        const FilterTarget target{grain, at, grain.bounding_radius, skin};
        const double precision = target.margin * target.spacing;
        ASSERT_LT(precision, 2e-3 * grain.bounding_radius);
        std::array<float, 37> found{};
        filter(target, cloud.points(true), found.data());
        for (std::size_t n = 0; n < found.size(); ++n) {
          const Vec3 point = at.turn * Vec3{cloud.x[n], cloud.y[n], cloud.z[n]} + at.shift;
          const double exact = std::max(clearance.of_sphere(point), clearance.of_grid(point)) -
                               cloud.radius[n] * target.spacing;
          ASSERT_LE(target.in_metres(found[n]), exact) << n;
          // Just outside a grid that cuts the grain, the bound may be that from inside.
          if (exact > precision) {
            ASSERT_GE(target.in_metres(found[n]), exact - 2 * precision) << n;
          }
        }
      }
    }
  }
}

TEST(PointFilter, LevelsThatCannotRunAreRefused) {
  const std::vector<SimdLevel> here = simd_levels_here();
  EXPECT_EQ(here.front(), SimdLevel::scalar);
  EXPECT_EQ(resolve(SimdLevel::automatic), here.back());
  int refused = 0;
  for (const SimdLevel level : {SimdLevel::avx2, SimdLevel::avx512, SimdLevel::neon}) {
    if (std::find(here.begin(), here.end(), level) != here.end()) {
      EXPECT_EQ(resolve(level), level);
      continue;
    }
    EXPECT_THROW(static_cast<void>(resolve(level)), Error);
    ++refused;
  }
  EXPECT_GT(refused, 0);  // no machine has both NEON and AVX
}

}  // namespace
}  // namespace reckon
