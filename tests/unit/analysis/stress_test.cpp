// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/stress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reckon/analysis/shear_curve.hpp"
#include "reckon/math/rotation.hpp"

namespace reckon {
namespace {

TEST(Stress, TriaxialStateGivesItsAngleWhateverTheAxes) {
  // sigma_1 = 3 sigma_3 mobilises asin(2/4) = 30 degrees.
  const Mat3 upright{{100, 0, 0}, {0, 100, 0}, {0, 0, 300}};
  const Mat3 turn = rotation_matrix(normalized(Quaternion{0.8, 0.3, -0.4, 0.2}));
  for (const Mat3& stress : {upright, turn * upright * transpose(turn)}) {
    const StressInvariants found = invariants(stress);
    EXPECT_NEAR(found.mean, 500.0 / 3, 1e-10);
    EXPECT_NEAR(found.deviator, 200, 1e-10);
    EXPECT_NEAR(found.friction_angle, 30, 1e-10);
  }
}

TEST(Stress, PureShearIsDeviatorOfRootThree) {
  EXPECT_NEAR(invariants({{0, 5, 0}, {5, 0, 0}, {0, 0, 0}}).deviator, std::sqrt(3.0) * 5, 1e-12);
}

TEST(Stress, DegreesOfSineInvertsTheSine) {
  for (const double angle : {-90.0, -33.3, 0.0, 1e-3, 41.7, 90.0}) {
    EXPECT_NEAR(degrees_of_sine(std::sin(angle * std::numbers::pi / 180)), angle, 2e-6);
  }
}

TEST(ShearCurve, FindsPeakAndDilatancyOfAKnownCurve) {
  // A parabola of 40 degrees at 5 % strain that falls to a plateau of 30, with the volume growing
  // by 0.6 of the axial strain: sin(psi) = 0.6 / 2.6.
  std::vector<ShearPoint> curve;
  for (int n = 0; n <= 400; ++n) {
    const double strain = 0.2 * n / 400;
    const double off = (strain - 0.05) / 0.05;
    curve.push_back(
        {strain, strain < 0.1 ? -0.6 * strain : -0.06, strain < 0.1 ? 40 - 10 * off * off : 30});
  }
  const auto found = summarize(curve);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->peak_friction_angle, 40, 0.02);
  EXPECT_NEAR(found->strain_at_peak, 0.05, 1e-3);
  EXPECT_NEAR(found->dilatancy_angle, std::asin(0.6 / 2.6) * 180 / std::numbers::pi, 1e-6);
  EXPECT_NEAR(found->final_friction_angle, 30, 1e-9);
  EXPECT_NEAR(found->final_dilatancy_angle, 0, 1e-9);
}

TEST(ShearCurve, ASingleWiggleMakesNoPeak) {
  std::vector<ShearPoint> curve;
  for (int n = 0; n <= 1000; ++n) curve.push_back({0.0002 * n, 0, 30});
  curve[300].friction_angle = 45;
  EXPECT_LT(summarize(curve)->peak_friction_angle, 31);
}

/// A stage of a cyclic test is shorter than the usual window, over which its peak would be hidden.
TEST(ShearCurve, NoPeakIsBelowTheFinalValue) {
  std::vector<ShearPoint> curve;
  for (int n = 0; n <= 100; ++n) curve.push_back({3e-5 * n, 0, 0.22 * n});
  const auto rising = summarize(curve);
  EXPECT_NEAR(rising->final_friction_angle, 19.8, 0.1);
  EXPECT_GE(rising->peak_friction_angle, rising->final_friction_angle);
  EXPECT_TRUE(rising->still_rising);
  for (std::size_t n = 50; n < curve.size(); ++n) curve[n].friction_angle = 8;
  const auto peaked = summarize(curve);
  EXPECT_NEAR(peaked->peak_friction_angle, 9.7, 0.1);
  EXPECT_FALSE(peaked->still_rising);
}

TEST(ShearCurve, NothingWithoutShear) {
  EXPECT_FALSE(summarize({}).has_value());
  const std::vector<ShearPoint> still(5);
  EXPECT_FALSE(summarize(still).has_value());
}

}  // namespace
}  // namespace reckon
