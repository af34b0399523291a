// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/math/portable.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reckon/core/random.hpp"

namespace reckon {
namespace {

TEST(PortableFunctions, AgreeWithTheCLibrary) {
  RandomStream random{1, RandomPurpose::other, 0};
  for (int n = 0; n < 100000; ++n) {
    const double x = std::ldexp(random.uniform(0.5, 1), static_cast<int>(random.uniform(-60, 60)));
    ASSERT_NEAR(portable::log(x), std::log(x), 4e-16 * std::abs(std::log(x)) + 2e-16) << x;
    const double y = random.uniform(-300, 300);
    ASSERT_NEAR(portable::exp(y) / std::exp(y), 1, 1e-15) << y;
    const double turns = random.uniform(-3, 3);
    const auto [cosine, sine] = portable::cos_sin_of_turns(turns);
    ASSERT_NEAR(cosine, std::cos(2 * std::numbers::pi * turns), 4e-15) << turns;
    ASSERT_NEAR(sine, std::sin(2 * std::numbers::pi * turns), 4e-15) << turns;
    const double power = random.uniform(0.1, 5);
    ASSERT_NEAR(portable::pow(x, power) / std::pow(x, power), 1, 1e-13) << x << ' ' << power;
  }
}

TEST(PortableFunctions, AreExactWhereTheyShouldBe) {
  EXPECT_EQ(portable::log(1), 0);
  EXPECT_EQ(portable::exp(0), 1);
  EXPECT_EQ(portable::pow(0, 2), 0);
  for (int quarter = -5; quarter <= 5; ++quarter) {
    const auto [cosine, sine] = portable::cos_sin_of_turns(0.25 * quarter);
    EXPECT_EQ(cosine, quarter % 2 != 0 ? 0 : quarter % 4 == 0 ? 1 : -1);
    EXPECT_EQ(sine, quarter % 2 == 0 ? 0 : (quarter + 8) % 4 == 1 ? 1 : -1);
  }
}

// The bits themselves, so that a machine or compiler that rounds otherwise is found out.
TEST(PortableFunctions, HaveTheseBits) {
  EXPECT_EQ(portable::log(3), 0x1.193ea7aad030ap+0);
  EXPECT_EQ(portable::exp(1), 0x1.5bf0a8b14576ap+1);
  EXPECT_EQ(portable::cos_sin_of_turns(0.1).cos, 0x1.9e3779b97f4a8p-1);
  EXPECT_EQ(portable::cos_sin_of_turns(0.1).sin, 0x1.2cf2304755a5ep-1);
}

TEST(Portable, CubeRootIsRightToTheLastBits) {
  for (double x = 1e-30; x < 1e30; x *= 1.7) {
    EXPECT_NEAR(portable::cbrt(x) / std::cbrt(x), 1, 5e-16) << x;
  }
}

}  // namespace
}  // namespace reckon
