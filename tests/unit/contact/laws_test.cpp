// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "reckon/contact/area_law.hpp"
#include "reckon/contact/linear_law.hpp"

namespace reckon {
namespace {

constexpr double dt = 1e-5;
const Vec3 up{0, 0, 1};

PairContext context(double friction) {
  return {.effective_mass = 0.25,
          .friction = friction,
          .total_area = 0.02,
          .total_volume = 2e-5,
          .touching = 4,
          .time_step = dt};
}

TEST(Coulomb, SpringStretchesAgainstTheMotionUntilItSlides) {
  const Vec3 velocity{2, 0, 5};  // the normal part must not stretch it
  Vec3 spring;
  for (int n = 0; n < 10; ++n) {
    const CoulombSlider s = slide(spring, velocity, up, dt, 1e4, 1e9);
    spring = s.force;
    EXPECT_EQ(s.lost, 0);
  }
  EXPECT_NEAR(spring.x, -1e4 * 2 * 10 * dt, 1e-12);
  EXPECT_EQ(spring.z, 0);
  const CoulombSlider capped = slide(spring, velocity, up, dt, 1e4, 0.5);
  EXPECT_NEAR(norm(capped.force), 0.5, 1e-15);
}

TEST(Coulomb, SteadySlidingLosesForceTimesDistance) {
  Vec3 spring{-3, 0, 0};
  double lost = 0;
  for (int n = 0; n < 1000; ++n) {
    const CoulombSlider s = slide(spring, {2, 0, 0}, up, dt, 1e6, 3);
    spring = s.force;
    lost += s.lost;
  }
  EXPECT_NEAR(lost, 3 * 2 * 1000 * dt, 1e-12);
}

TEST(Coulomb, NothingIsLostWithoutFriction) {
  const CoulombSlider s = slide({}, {2, 1, 0}, up, dt, 1e6, 0);
  EXPECT_EQ(s.force, Vec3{});
  EXPECT_EQ(s.lost, 0);
}

TEST(LinearLaw, ForceIsStiffnessTimesDepthAlongTheUnitNormal) {
  const LinearLaw law{1e5, 9e4, 0, 0};
  const Touch touch{.node = 0, .phi = -1e-3, .gradient_world = {0, 0, 0.8}};
  const NodeResponse r = law.respond(context(0), touch, up, {}, {});
  EXPECT_NEAR(r.force.z, 100, 1e-12);  // the gradient's length does not count
  EXPECT_NEAR(r.elastic, 0.5 * 1e5 * 1e-6, 1e-15);
}

TEST(LinearLaw, CapScalesPairsWithManyNodes) {
  const LinearLaw law{1e5, 9e4, 0, 16};
  PairContext pair = context(0);
  pair.touching = 16;
  EXPECT_EQ(law.pair_scale(pair), 1.0);
  pair.touching = 40;
  EXPECT_EQ(law.pair_scale(pair), 0.4);
}

TEST(AreaLaw, ForceFollowsAreaDepthAndTheGradientAsItIs) {
  const AreaLaw law{1e8, 5e7, 0};
  const Touch touch{.node = 0, .phi = -1e-3, .gradient_world = {0, 0, 0.8}, .area = 0.005};
  const NodeResponse r = law.respond(context(0), touch, up, {}, {});
  EXPECT_NEAR(r.force.z, 1e8 * 0.005 * 1e-3 * 0.8, 1e-9);
}

TEST(AreaLaw, DashpotNeverPulls) {
  const AreaLaw law{1e8, 5e7, 1.5};
  const Touch touch{.node = 0, .phi = -1e-6, .gradient_world = up, .area = 0.005};
  const NodeResponse leaving = law.respond(context(0.5), touch, up, {0, 0, 50}, {1, 0, 0});
  EXPECT_EQ(leaving.force, Vec3{});  // no push, hence no friction either
  const NodeResponse coming = law.respond(context(0), touch, up, {0, 0, -50}, {});
  EXPECT_GT(coming.force.z, 1e8 * 0.005 * 1e-6);
  EXPECT_GT(coming.dashpot_push, 0);
}

TEST(DashpotLoss, IsTheMeanPushTimesTheWayAndOfALeavingNodeTheWhole) {
  const NodeResponse now{.dashpot_push = 6};
  const Touch deep{.phi = -1e-3};
  EXPECT_DOUBLE_EQ(dashpot_loss(10, now, deep, -2, 1e-4), 8 * 2e-4);
  EXPECT_DOUBLE_EQ(dashpot_loss(0, now, deep, -2, 1e-4), 3 * 2e-4);
  const NodeResponse pulls{.dashpot_push = -6};
  EXPECT_DOUBLE_EQ(dashpot_loss(-10, pulls, deep, 2, 1e-4), 8 * 2e-4);
  const Touch leaving{.phi = -1e-4};
  EXPECT_DOUBLE_EQ(dashpot_loss(-10, pulls, leaving, 2, 1e-4), 11 * 2e-4);
}

/// One head-on impact of a mass on a spring force K x^p, integrated independently of the engine.
double rebound_ratio(double power, double alpha, bool pulls, double speed) {
  const double m = 0.3;
  const double stiffness = 7e6;
  double x = 0;
  double v = speed;
  const double step = 1e-8;
  while (x > 0 || v > 0) {
    const double tangent = power * stiffness * std::pow(std::max(x, 0.0), power - 1);
    double push =
        stiffness * std::pow(std::max(x, 0.0), power) + alpha * std::sqrt(m * tangent) * v;
    if (!pulls) push = std::max(push, 0.0);
    v -= push / m * step;
    x += v * step;
    if (x <= 0 && v < 0) break;
  }
  return -v / speed;
}

TEST(DashpotFactor, LinearSpringReturnsTheSetShare) {
  for (const double e : {0.2, 0.6, 0.95}) {
    EXPECT_NEAR(rebound_ratio(1, linear_dashpot_factor(e), true, 0.7), e, 1e-3);
  }
}

TEST(DashpotFactor, RoundContactReturnsTheSetShareAtAnySpeed) {
  for (const double e : {0.2, 0.6, 0.95}) {
    for (const double speed : {0.1, 3.0}) {
      EXPECT_NEAR(rebound_ratio(2, area_dashpot_factor(e), false, speed), e, 2e-3);
    }
  }
}

}  // namespace
}  // namespace reckon
