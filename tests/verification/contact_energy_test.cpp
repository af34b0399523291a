// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// The energy balance of contacts whose tangential stiffness follows their size: library spheres
// under laws `area` and `hertz`, and nodes under law `hertz`. It must close with the time step.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "reckon/simulation/simulation.hpp"
#include "support/test_shapes.hpp"
#include "support/verification_table.hpp"

namespace reckon {
namespace {

constexpr double radius = 1e-3;

struct Impact {
  bool hertz;
  bool on_plane;
  double degrees;  // from the normal
  double spin;     // about y [rad/s]
};

/// What the balance lacks after an impact over the kinetic energy before.
double lacking(const Impact& impact, const Shape& shape, double step_fraction) {
  SimulationSetup setup;
  setup.shapes = testing::library_of({shape});
  setup.density = 2650;
  const AnyContactLaw law = impact.hertz ? AnyContactLaw{hertz_law(1e8, 0.25, impact.on_plane, 0)}
                                         : AnyContactLaw{AreaLaw{1e11, 9e10, 0}};
  setup.contact = {law, 0.5};
  setup.time_step = step_fraction * 1e-5;
  setup.skin = 0.1 * radius;
  SimulationState state;
  const double angle = impact.degrees * std::numbers::pi / 180;
  GrainState grain;
  grain.position = {0, 0, 1.02 * radius};
  grain.velocity = {std::sin(angle), 0, -std::cos(angle)};
  grain.angular_velocity_body = {0, impact.spin, 0};
  state.grains = {grain};
  if (impact.on_plane) {
    setup.walls = {{"floor", PlaneSurface{{}, {0, 0, 1}}, law, 0.5, false, {}}};
  } else {
    grain.id = GrainId{1};
    grain.position *= -1;
    grain.velocity *= -1;
    state.grains.push_back(grain);
  }
  Simulation simulation{setup, state};
  const EnergyBudget before = simulation.measure().energy;
  for (int n = 0; n * setup.time_step < 6e-4; ++n) simulation.step();
  const EnergyBudget after = simulation.measure().energy;
  EXPECT_EQ(after.elastic, 0);  // it is over
  EXPECT_GT(after.friction, 0.001 * before.translation);
  return (after.total() - before.total()) / (before.translation + before.rotation);
}

TEST(ContactEnergy, BalanceOfAnImpactClosesWithTheTimeStep) {
  const Shape nodes = testing::sphere(radius, 1600);
  Shape sphere = nodes;
  sphere.sphere_radius = radius;
  testing::VerificationTable table{"impact_energy",
                                   "law,sphere,on_plane,degrees,spin,step_0.1,step_0.01"};
  for (const bool hertz : {false, true}) {
    for (const bool known : {false, true}) {
      const Shape& shape = known ? sphere : nodes;
      for (const bool on_plane : {true, false}) {
        for (const auto& [degrees, spin] : {std::pair{45.0, 0.0}, std::pair{20.0, 0.0},
                                            std::pair{80.0, 1500.0}, std::pair{45.0, -800.0}}) {
          if (!on_plane && degrees > 60) continue;  // they would miss each other
          const Impact impact{hertz, on_plane, degrees, spin};
          const double coarse = lacking(impact, shape, 0.1);
          const double fine = lacking(impact, shape, 0.01);
          table.row({hertz ? 1.0 : 0.0, known ? 1.0 : 0.0, on_plane ? 1.0 : 0.0, degrees, spin,
                     coarse, fine});
          EXPECT_LT(std::abs(coarse), 2e-3) << hertz << on_plane << degrees;
          EXPECT_LT(std::abs(fine), 2e-4) << hertz << on_plane << degrees;
        }
      }
    }
  }
}

/// Grains of few nodes in a box of which one wall moves in slowly and out again: what the balance
/// lacks over the work of the wall on its way in.
double lacking_in_slow_stage(const AnyContactLaw& law, const Shape& shape) {
  SimulationSetup setup;
  setup.shapes = testing::library_of({shape});
  setup.density = 2650;
  setup.contact = {law, 0.4};
  const double pitch = 1.75;
  const double edge = 3 * pitch;
  const double speed = 0.4;
  const double half_time = 0.4;
  setup.walls = {{"x-", PlaneSurface{{0, 0, 0}, {1, 0, 0}}, law, 0.3, false, {}},
                 {"x+", PlaneSurface{{edge, 0, 0}, {-1, 0, 0}}, law, 0.3, false, {}},
                 {"y-", PlaneSurface{{0, 0, 0}, {0, 1, 0}}, law, 0.3, false, {}},
                 {"y+", PlaneSurface{{0, edge, 0}, {0, -1, 0}}, law, 0.3, false, {}},
                 {"z-", PlaneSurface{{0, 0, 0}, {0, 0, 1}}, law, 0.3, false, {}},
                 {"z+", PlaneSurface{{0, 0, edge}, {0, 0, -1}}, law, 0.3, false, {}}};
  setup.walls[1].motion = WallMotion{.velocity = {-speed, 0, 0}, .stop = half_time};
  setup.damping = 5;
  setup.time_step = 1e-4;
  setup.skin = 0.1;
  SimulationState state;
  for (std::uint32_t n = 0; n < 27; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    grain.position = pitch * Vec3{n % 3 + 0.5, n / 3 % 3 + 0.5, std::floor(n / 9.0) + 0.5};
    grain.orientation = normalized(Quaternion{1, std::sin(1.0 * n), std::cos(2.0 * n), 0.3});
    state.grains.push_back(grain);
  }
  Simulation simulation{setup, state};
  const EnergyBudget before = simulation.measure().energy;
  while (simulation.time() < 1.5 * half_time) simulation.step();
  const EnergyBudget after = simulation.measure().energy;
  EXPECT_GT(after.friction, 0.02 * after.wall_work);
  return (after.total() - before.total()) / after.wall_work;
}

TEST(ContactEnergy, BalanceOfASlowStageCloses) {
  const AnyContactLaw hertz = hertz_law(1e8, 0.25, false, 0);
  EXPECT_LT(std::abs(lacking_in_slow_stage(hertz, testing::bumpy_grain(1.0, 200, 16))), 1e-3);
  EXPECT_LT(
      std::abs(lacking_in_slow_stage(AreaLaw{2e7, 2e7, 0}, testing::bumpy_grain(1.0, 200, 16))),
      1e-3);
  Shape sphere = testing::sphere(0.95, 300);
  EXPECT_LT(std::abs(lacking_in_slow_stage(hertz, sphere)), 1e-3);
  sphere.sphere_radius = 0.95;
  EXPECT_LT(std::abs(lacking_in_slow_stage(hertz, sphere)), 1e-3);
}

}  // namespace
}  // namespace reckon
