// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "reckon/contact/area_law.hpp"
#include "reckon/contact/hertz_law.hpp"
#include "reckon/contact/linear_law.hpp"
#include "reckon/contact/pair_kernel.hpp"

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
    const CoulombSlider s = slide({spring, 1e4}, velocity, up, dt, 1e4, 1e9);
    spring = s.force;
    EXPECT_EQ(s.lost, 0);
  }
  EXPECT_NEAR(spring.x, -1e4 * 2 * 10 * dt, 1e-12);
  EXPECT_EQ(spring.z, 0);
  const CoulombSlider capped = slide({spring, 1e4}, velocity, up, dt, 1e4, 0.5);
  EXPECT_NEAR(norm(capped.force), 0.5, 1e-15);
}

TEST(Coulomb, SteadySlidingLosesForceTimesDistance) {
  Vec3 spring{-3, 0, 0};
  double lost = 0;
  for (int n = 0; n < 1000; ++n) {
    const CoulombSlider s = slide({spring, 1e6}, {2, 0, 0}, up, dt, 1e6, 3);
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

/// A spring under a stiffness that grows and shrinks while its end goes to and fro: what is put in
/// is what it stores and what is lost, and nothing is ever won.
TEST(Coulomb, ChangingStiffnessKeepsTheBalance) {
  ShearSpring spring{{}, 1e5};
  double lost = 0;
  double work = 0;
  double slid = 0;
  for (int n = 0; n < 4000; ++n) {
    const double stiffness = 1e5 * (1.1 + std::sin(0.003 * n));
    const Vec3 velocity{std::cos(0.005 * n), 0.3 * std::sin(0.011 * n), 0};
    const CoulombSlider s = slide(spring, velocity, up, dt, stiffness, 150);
    work -= dot(0.5 * (spring.force + s.force), velocity * dt);
    EXPECT_GE(s.lost, -1e-6);
    if (norm(s.force) > 149.999) slid += s.lost;
    lost += s.lost;
    spring = {s.force, stiffness};
  }
  EXPECT_GT(slid, 0);
  EXPECT_GT(lost, 1.05 * slid);
  EXPECT_NEAR(work, lost + spring.stored(), 1e-12 * work);
}

TEST(Coulomb, ShrinkingContactKeepsItsStretchAndAGrowingOneItsForce) {
  const CoulombSlider less = slide({{3, 0, 0}, 2e4}, {}, up, dt, 1e4, 10);
  EXPECT_EQ(less.force, (Vec3{1.5, 0, 0}));
  EXPECT_DOUBLE_EQ(less.lost, 9 / 4e4 - 2.25 / 2e4);
  const CoulombSlider more = slide({{3, 0, 0}, 1e4}, {}, up, dt, 2e4, 10);
  EXPECT_EQ(more.force, (Vec3{3, 0, 0}));
  EXPECT_DOUBLE_EQ(more.lost, 9 / 2e4 - 9 / 4e4);
  const CoulombSlider unknown = slide({{3, 0, 0}, 0}, {}, up, dt, 2e4, 10);
  EXPECT_EQ(unknown.force, (Vec3{3, 0, 0}));
  EXPECT_EQ(unknown.lost, 0);
}

/// Nodes that lie at random, some still outside: minus the derivative of the energy is the force.
TEST(HertzLaw, PushIsMinusTheDerivativeOfTheEnergy) {
  const HertzLaw law = hertz_law(1e8, 0.2, false, 0);
  const auto energy_and_push = [&](double shift) {
    std::vector<Touch> touches;
    for (int n = 0; n < 12; ++n) {
      const double phi = 1e-4 * (std::sin(7.0 * n) - 0.2) - shift;
      if (phi < 0) {
        touches.push_back({static_cast<NodeIndex>(n), phi, up, {}, 1e-6 * (1.5 + std::cos(n))});
      }
    }
    PairContext pair = context(0);
    count_touches(pair, touches);
    double energy = 0;
    double push = 0;
    for (const Touch& touch : touches) {
      const NodeForce node = law.node_force(pair, touch, up, {}, {});
      energy += node.elastic;
      push += node.force.z;
    }
    return std::pair{energy, push};
  };
  double work = 0;
  const double step = 1e-8;
  for (int n = 0; n < 20000; ++n) work += energy_and_push((n + 0.5) * step).second * step;
  const double stored = energy_and_push(20000 * step).first - energy_and_push(0).first;
  EXPECT_NEAR(work, stored, 1e-7 * stored);
}

TEST(LinearLaw, ForceIsStiffnessTimesDepthAlongTheUnitNormal) {
  const LinearLaw law{1e5, 9e4, 0, 0};
  const Touch touch{.node = 0, .phi = -1e-3, .gradient_world = {0, 0, 0.8}};
  const NodeForce r = law.node_force(context(0), touch, up, {}, {});
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
  const NodeForce r = law.node_force(context(0), touch, up, {}, {});
  EXPECT_NEAR(r.force.z, 1e8 * 0.005 * 1e-3 * 0.8, 1e-9);
}

TEST(AreaLaw, DashpotNeverPulls) {
  const AreaLaw law{1e8, 5e7, 1.5};
  const Touch touch{.node = 0, .phi = -1e-6, .gradient_world = up, .area = 0.005};
  const NodeForce leaving = law.node_force(context(0.5), touch, up, {0, 0, 50}, {{1, 0, 0}, 1e5});
  EXPECT_EQ(leaving.force, Vec3{});  // no push, hence no friction either
  const NodeForce coming = law.node_force(context(0), touch, up, {0, 0, -50}, {});
  EXPECT_GT(coming.force.z, 1e8 * 0.005 * 1e-6);
  EXPECT_GT(coming.dashpot_push, 0);
}

TEST(DashpotLoss, IsTheMeanPushTimesTheWayAndOfALeavingNodeTheWhole) {
  const NodeForce now{.dashpot_push = 6};
  const Touch deep{.phi = -1e-3};
  EXPECT_DOUBLE_EQ(dashpot_loss(10, now, deep, -2, 1e-4), 8 * 2e-4);
  EXPECT_DOUBLE_EQ(dashpot_loss(0, now, deep, -2, 1e-4), 3 * 2e-4);
  const NodeForce pulls{.dashpot_push = -6};
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
