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

/// What a head-on impact takes from the motion, and what is counted as lost to dashpots [J].
struct Loss {
  double before;  ///< energy of the motion
  double taken;
  double counted;
};

/// A sphere hits a plane, or its like, which takes some thirty steps.
Loss head_on(const AnyContactLaw& law, const Shape& shape, bool on_plane) {
  SimulationSetup setup;
  setup.shapes = testing::library_of({shape});
  setup.density = 4000;
  setup.contact = {law, 0.3, MasterRule::lower_id};
  setup.time_step = 1e-6;
  setup.skin = 0.1 * radius;
  SimulationState state;
  const auto add = [&](std::uint32_t id, double z, double along) {
    GrainState grain;
    grain.id = GrainId{id};
    grain.position.z = z;
    grain.velocity.z = along;
    state.grains.push_back(grain);
  };
  add(0, 1.001 * radius, -speed);
  if (on_plane) {
    setup.walls = {{"floor", PlaneSurface{{}, {0, 0, 1}}, law, 0.3, false, {}}};
  } else {
    add(1, -1.001 * radius, speed);
  }
  Simulation simulation{setup, state};
  const EnergyBudget before = simulation.measure().energy;
  for (int n = 0; n < 1000 && simulation.grains().position[0].z < 1.002 * radius; ++n) {
    simulation.step();
  }
  const EnergyBudget after = simulation.measure().energy;
  EXPECT_EQ(after.elastic, 0);
  return {before.translation,
          before.translation - after.translation - after.rotation - after.friction, after.dashpot};
}

TEST(NormalImpact, DashpotsTakeWhatTheMotionLoses) {
  const Shape nodes = testing::sphere(radius, 1600);
  Shape sphere = nodes;
  sphere.sphere_radius = radius;
  testing::VerificationTable table{"dashpot_loss", "law,restitution,on_plane,taken,counted"};
  for (const double e : {0.3, 0.6, 0.9}) {
    for (const bool on_plane : {true, false}) {
      const std::vector<AnyContactLaw> laws{
          // The share is that of one node; some fifty touch.
          LinearLaw{1e5, 9e4, linear_dashpot_factor(e) / 7, 0},
          AreaLaw{8e12, 7e12, area_dashpot_factor(e)},
          hertz_law(on_plane ? 6e9 : 12e9, 0.2, on_plane, hertz_dashpot_factor(e))};
      for (std::size_t law = 0; law < laws.size(); ++law) {
        for (const Shape* shape : {&nodes, static_cast<const Shape*>(&sphere)}) {
          if (law == 0 && shape == &sphere) continue;  // law `linear` has no sphere without nodes
          const Loss loss = head_on(laws[law], *shape, on_plane);
          table.row({static_cast<double>(law), e, on_plane ? 1.0 : 0.0, loss.taken, loss.counted});
          EXPECT_NEAR(loss.counted / loss.before, loss.taken / loss.before, 0.006)
              << "law " << law << ", e " << e;
        }
      }
    }
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
