// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/hertz_law.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reckon/contact/contact_settings.hpp"

namespace reckon {
namespace {

const Vec3 up{0, 0, 1};
constexpr double radius = 0.3;    // R* [m]
constexpr double overlap = 0.01;  // [m]

/// The lens of this depth that a paraboloid of curvature R* cuts into a plane.
PairContext lens(double friction = 0, double depth = overlap) {
  const double area_per_depth = 2 * std::numbers::pi * radius;
  return {.effective_mass = 0.25,
          .friction = friction,
          .total_area = area_per_depth * depth,
          .total_volume = area_per_depth * std::pow(depth, 2) / 2,
          .third_moment = area_per_depth * std::pow(depth, 4) / 4,
          .fourth_moment = area_per_depth * std::pow(depth, 5) / 5,
          .touching = 1,
          .time_step = 1e-5};
}
/// One node that stands for the whole lens.
Touch whole_lens(const PairContext& context) {
  const double depth = context.fourth_moment / context.third_moment;
  return {
      .phi = -depth, .gradient_world = up, .area = context.third_moment / (depth * depth * depth)};
}

TEST(HertzLaw, GivesHertzsForceEnergyAndStiffness) {
  const HertzLaw law = hertz_law(70e9, 0.3, true, 0);
  EXPECT_NEAR(law.normal_modulus, 70e9 / 0.91, 1);
  const PairContext context = lens();
  const NodeForce r = law.node_force(context, whole_lens(context), up, {}, {});
  const double force = 4.0 / 3 * law.normal_modulus * std::sqrt(radius) * std::pow(overlap, 1.5);
  EXPECT_NEAR(r.force.z / force, 1, 1e-12);
  EXPECT_NEAR(r.elastic / (0.4 * force * overlap), 1, 1e-12);
  EXPECT_NEAR(law.pair_stiffness(context) / (1.5 * force / overlap), 1, 1e-12);
}

TEST(HertzLaw, GivesMindlinsTangentialStiffness) {
  // Two equal spheres: K_t / K_n = 2 (1 - nu) / (2 - nu) with K_n = 2 E* a (Johnson 1985, 7.44).
  const double nu = 0.25;
  const HertzLaw law = hertz_law(50e9, nu, false, 0);
  const PairContext context = lens(1e9);
  const Vec3 velocity{1e-3, 0, 0};
  const NodeForce r = law.node_force(context, whole_lens(context), up, velocity, {});
  const double found = -r.shear_force.x / (velocity.x * context.time_step);
  EXPECT_NEAR(found / law.pair_stiffness(context), 2 * (1 - nu) / (2 - nu), 1e-9);
}

TEST(HertzLaw, FrictionIsCappedAndNoNodePulls) {
  const HertzLaw law = hertz_law(50e9, 0.25, false, hertz_dashpot_factor(0.2));
  const PairContext context = lens(0.4);
  const Touch touch = whole_lens(context);
  const NodeForce sliding = law.node_force(context, touch, up, {1e5, 0, 0}, {});
  EXPECT_NEAR(norm(sliding.shear_force), 0.4 * sliding.force.z, 1e-6 * sliding.force.z);
  EXPECT_EQ(law.node_force(context, touch, up, {0, 0, 1e9}, {}).force, Vec3{});
}

/// A mass falls onto the lens of a growing overlap.
TEST(HertzLaw, ReturnsTheSetRestitutionAtAnySpeed) {
  for (const double restitution : {0.3, 0.6, 0.9}) {
    for (const double speed : {0.01, 1.0}) {
      const HertzLaw law = hertz_law(1e8, 0.2, true, hertz_dashpot_factor(restitution));
      const double mass = 0.25;
      const double dt = 2e-8 / std::pow(speed, 0.2);
      double depth = 0;
      double velocity = speed;  // inward
      do {
        depth = std::max(depth + dt * velocity, 0.0);
        if (depth == 0) break;
        const PairContext context = lens(0, depth);
        velocity -= dt / mass *
                    law.node_force(context, whole_lens(context), up, {0, 0, -velocity}, {}).force.z;
      } while (depth > 0 && velocity > -2 * speed);
      EXPECT_NEAR(-velocity / speed, restitution, 0.005) << restitution << " at " << speed;
    }
  }
}

}  // namespace
}  // namespace reckon
