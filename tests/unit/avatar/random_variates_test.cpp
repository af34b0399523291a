// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/random_variates.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace reckon {
namespace {

constexpr int count = 200000;

struct Moments {
  double mean{0};
  double deviation{0};
};

template <class Draw>
Moments moments_of(Draw&& draw) {
  double sum = 0;
  double squares = 0;
  for (int n = 0; n < count; ++n) {
    const double value = draw();
    sum += value;
    squares += value * value;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean)};
}

TEST(RandomVariates, NormalHasItsMomentsAndTails) {
  RandomStream random{1, RandomPurpose::other, 0};
  int beyond_two = 0;
  const Moments found = moments_of([&] {
    const double x = standard_normal(random);
    beyond_two += std::abs(x) > 2 ? 1 : 0;
    return x;
  });
  EXPECT_NEAR(found.mean, 0, 0.01);
  EXPECT_NEAR(found.deviation, 1, 0.01);
  EXPECT_NEAR(static_cast<double>(beyond_two) / count, std::erfc(std::sqrt(2.0)), 0.002);
}

TEST(RandomVariates, GammaHasItsMoments) {
  for (const double shape : {0.3, 1.0, 7.5}) {
    RandomStream random{2, RandomPurpose::other, 0};
    const Moments found = moments_of([&] { return gamma_variate(random, shape); });
    EXPECT_NEAR(found.mean / shape, 1, 0.02) << shape;
    EXPECT_NEAR(found.deviation / std::sqrt(shape), 1, 0.02) << shape;
  }
}

TEST(RandomVariates, BoundedHasItsMomentsAndBounds) {
  const struct { double mean, deviation; } cases[] = {{0.78, 0.09}, {0.95, 0.04}, {0.4, 0.15}};
  for (const auto& wanted : cases) {
    RandomStream random{3, RandomPurpose::other, 0};
    const Moments found = moments_of([&] {
      const double x = bounded_variate(random, wanted.mean, wanted.deviation, 0.3, 1);
      EXPECT_TRUE(x >= 0.3 && x <= 1);
      return x;
    });
    EXPECT_NEAR(found.mean, wanted.mean, 0.001);
    EXPECT_NEAR(found.deviation / wanted.deviation, 1, 0.02);
  }
  RandomStream random{4, RandomPurpose::other, 0};
  EXPECT_EQ(bounded_variate(random, 0.5, 0, 0.3, 1), 0.5);
}

TEST(RandomVariates, DirectionsAreIsotropic) {
  RandomStream random{5, RandomPurpose::other, 0};
  Vec3 sum;
  Vec3 squares;
  for (int n = 0; n < count; ++n) {
    const Vec3 d = random_direction(random);
    ASSERT_NEAR(norm(d), 1, 1e-14);
    sum += d;
    squares += hadamard(d, d);
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(sum[axis] / count, 0, 0.005);
    EXPECT_NEAR(squares[axis] / count, 1.0 / 3, 0.003);
  }
}

}  // namespace
}  // namespace reckon
