// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/predicates.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "reckon/core/random.hpp"

namespace reckon {
namespace {

__extension__ using Wide = __int128;
struct IntVec {
  std::int64_t x, y, z;
};

int sign_of(Wide value) { return (value > 0) - (value < 0); }

Vec3 scaled(const IntVec& v) {
  return Vec3{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)} *
         0x1p-40;
}

// Points near a common plane or line, so that rounding would decide most signs: integers are the
// oracle.
TEST(Predicates, AgreeWithIntegerArithmetic) {
  RandomStream random{1, RandomPurpose::other, 0};
  int zeros = 0;
  for (int n = 0; n < 20000; ++n) {
    const auto integer = [&](double range) {
      return static_cast<std::int64_t>(random.uniform(-range, range));
    };
    IntVec p[4];
    for (IntVec& v : p) {
      const double range = 1e11;
      v.x = integer(range);
      v.y = integer(range);
      v.z = v.x + 2 * v.y + integer(n % 2 == 0 ? 0.9 : 2.0);  // on or one off the plane
    }
    if (n % 3 == 0) p[2] = {2 * p[1].x - p[0].x, 2 * p[1].y - p[0].y + integer(2), p[2].z};
    const auto minus = [](const IntVec& a, const IntVec& b) {
      return IntVec{a.x - b.x, a.y - b.y, a.z - b.z};
    };
    const IntVec u = minus(p[1], p[0]);
    const IntVec v = minus(p[2], p[0]);
    const IntVec w = minus(p[3], p[0]);
    // The plane's own part cancels before the third factor, so that 128 bits are enough.
    const auto off = [](const IntVec& a) { return Wide{a.z} - a.x - 2 * Wide{a.y}; };
    const Wide determinant = off(w) * (Wide{u.x} * v.y - Wide{u.y} * v.x) -
                             off(v) * (Wide{u.x} * w.y - Wide{u.y} * w.x) +
                             off(u) * (Wide{v.x} * w.y - Wide{v.y} * w.x);
    zeros += determinant == 0 ? 1 : 0;
    ASSERT_EQ(orientation(scaled(p[0]), scaled(p[1]), scaled(p[2]), scaled(p[3])),
              sign_of(determinant));
    ASSERT_EQ(turn(scaled(p[0]), scaled(p[1]), scaled(p[2]), 2),
              sign_of(Wide{u.x} * v.y - Wide{u.y} * v.x));
    ASSERT_EQ(turn(scaled(p[0]), scaled(p[1]), scaled(p[2]), 0),
              sign_of(Wide{u.y} * v.z - Wide{u.z} * v.y));
  }
  EXPECT_GT(zeros, 5000);
}

TEST(Predicates, SignsFollowTheRightHandRule) {
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, -1e-300}), -1);
  EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 0}), 0);
  EXPECT_EQ(turn({0, 0, 7}, {1, 0, 8}, {0, 1, 9}, 2), 1);
  EXPECT_EQ(turn({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0), 1);
  EXPECT_EQ(turn({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 1), 1);
}

}  // namespace
}  // namespace reckon
