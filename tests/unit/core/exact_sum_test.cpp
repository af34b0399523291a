// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/exact_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace reckon {
namespace {

TEST(ExactSum, AgreesWithHandPickedSums) {
  EXPECT_EQ(exact_sum(std::vector<double>{}), 0.0);
  EXPECT_EQ(exact_sum(std::vector{0.1}), 0.1);
  EXPECT_EQ(exact_sum(std::vector{-0.1}), -0.1);
  EXPECT_EQ(exact_sum(std::vector{1e300, 1.0, -1e300}), 1.0);
  EXPECT_EQ(exact_sum(std::vector{1.0, 0x1p-53, 0x1p-200}), 1.0 + 0x1p-52);  // ties broken by dust
  EXPECT_EQ(exact_sum(std::vector{1.0, 0x1p-53}), 1.0);                      // tie to even
  EXPECT_EQ(exact_sum(std::vector{-1e-310, 3e-310}), 2e-310);
  EXPECT_EQ(exact_sum(std::vector{std::numeric_limits<double>::denorm_min()}),
            std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(exact_sum(std::vector{std::numeric_limits<double>::max()}),
            std::numeric_limits<double>::max());
  EXPECT_TRUE(std::isnan(exact_sum(std::vector{1.0, std::numeric_limits<double>::infinity()})));
  EXPECT_TRUE(std::isnan(exact_sum(std::vector{std::nan("")})));
}

TEST(ExactSum, EverySingleDoubleComesBack) {
  std::mt19937_64 random{7};
  for (int n = 0; n < 100000; ++n) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(exact_sum(std::vector{value}), value);
  }
}

TEST(ExactSum, OrderAndSplitDoNotMatter) {
  std::mt19937_64 random{11};
  std::normal_distribution<double> exponent{0, 40};
  std::vector<double> values;
  for (int n = 0; n < 5000; ++n) {
    const double magnitude = std::ldexp(1.0 + 1e-3 * n, static_cast<int>(exponent(random)));
    values.push_back(n % 3 == 0 ? -magnitude : magnitude);
  }
  const double expected = exact_sum(values);
  for (int trial = 0; trial < 20; ++trial) {
    std::shuffle(values.begin(), values.end(), random);
    ExactSum left;
    ExactSum right;
    for (std::size_t n = 0; n < values.size(); ++n) (n % 7 < 3 ? left : right).add(values[n]);
    left.add(right);
    EXPECT_EQ(left.value(), expected);
  }
}

TEST(ExactSum, MatchesIntegerArithmetic) {
  std::mt19937_64 random{13};
  __extension__ __int128 total = 0;
  ExactSum sum;
  for (int n = 0; n < 10000; ++n) {
    const auto value = static_cast<std::int64_t>(random()) >> 12;  // exact as a double
    total += value;
    sum.add(static_cast<double>(value));
  }
  EXPECT_EQ(sum.value(), static_cast<double>(total));
}

}  // namespace
}  // namespace reckon
