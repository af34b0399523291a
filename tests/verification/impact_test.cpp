// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// A sphere that hits a plane. Gross sliding has closed forms whatever the stiffness:
//   v_t' = v_t - mu (1 + e) v_n,   w' = (5/2) mu (1 + e) v_n / r.
#include <gtest/gtest.h>

#include "support/verification_table.hpp"
#include "verification/one_grain_on_plane.hpp"

namespace reckon {
namespace {

using testing::OneGrainOnPlane;

// Alumina sphere of Chung and Ooi (2011), test 4.
constexpr double radius = 2.5e-3;
constexpr double speed = 3.9;

struct Rebound {
  double normal;      ///< v_n' / v_n
  double tangential;  ///< v_t' / v_t
  double spin;        ///< [rad/s]
};

Rebound impact(double degrees_from_normal, double restitution, double friction,
               const Shape& shape) {
  OneGrainOnPlane scene;
  scene.density = 4000;
  scene.friction = friction;
  // Soft enough for many nodes to touch: the deepest overlap is about 4 % of the radius.
  scene.law = {8e12, 0.87 * 8e12, area_dashpot_factor(restitution)};
  scene.time_step = 5e-8;
  const double angle = degrees_from_normal * std::numbers::pi / 180;
  GrainState grain;
  grain.position = {0, 0, 1.0001 * radius};
  grain.orientation = normalized(Quaternion{0.7, 0.2, -0.4, 0.5});
  grain.velocity = {speed * std::sin(angle), 0, -speed * std::cos(angle)};
  Simulation simulation = scene.simulation(shape, grain);
  do {
    simulation.step();
  } while (simulation.grains().position[0].z < 1.0002 * radius ||
           simulation.grains().velocity[0].z < 0);
  const Grains& after = simulation.grains();
  return {after.velocity[0].z / -grain.velocity.z, after.velocity[0].x / grain.velocity.x,
          (rotation_matrix(after.orientation[0]) * after.angular_velocity_body[0]).y};
}

TEST(NormalImpact, ReturnsTheSetShareOfItsSpeed) {
  const Shape shape = testing::sphere(radius, 6400);
  testing::VerificationTable table{"restitution", "set,found"};
  for (const double e : {0.3, 0.5, 0.7, 0.9, 0.98}) {
    const Rebound r = impact(0.001, e, 0, shape);
    table.row({e, r.normal});
    EXPECT_NEAR(r.normal, e, 0.015);
  }
}

TEST(ObliqueImpact, SlidesByTheClosedFormAndGripsNearTheNormal) {
  const Shape shape = testing::sphere(radius, 6400);
  constexpr double mu = 0.092;
  constexpr double e = 0.98;
  testing::VerificationTable table{"oblique_impact", "degrees,tangential,spin,published"};
  const std::vector<std::pair<double, double>> published{{5, .948},  {10, .687}, {20, .616},
                                                         {30, .684}, {40, .781}, {50, .845},
                                                         {60, .893}, {80, .966}};
  for (const auto& [degrees, tangential] : published) {
    const Rebound r = impact(degrees, e, mu, shape);
    table.row({degrees, r.tangential, r.spin, tangential});
    const double angle = degrees * std::numbers::pi / 180;
    if (degrees >= 30) {
      EXPECT_NEAR(r.tangential, 1 - mu * (1 + e) / std::tan(angle), 0.012) << degrees;
      EXPECT_NEAR(r.tangential, tangential, 0.015) << degrees;
      EXPECT_NEAR(r.spin / (2.5 * mu * (1 + e) * speed * std::cos(angle) / radius), 1, 0.04);
    }
  }
}

}  // namespace
}  // namespace reckon
