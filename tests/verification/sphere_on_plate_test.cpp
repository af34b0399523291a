// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// A sphere of law `area` pressed onto a plate. Closed forms: the touching cap of overlap h has, by
// Archimedes, equal areas at equal depths, so F_n = pi R k h^2; forces weighted by depth act at
// the height R - h/3 below the centre, which is the lever of friction at the nodes.
#include <gtest/gtest.h>

#include "support/verification_table.hpp"
#include "verification/one_grain_on_plane.hpp"

namespace reckon {
namespace {

using std::numbers::pi;
using testing::OneGrainOnPlane;

constexpr double radius = 1;
constexpr double overlap = 0.05;
constexpr double normal_force = pi * radius * 1e8 * overlap * overlap;  // 785,398 N

struct PlateErrors {
  double normal, friction, torque;
};

/// Errors relative to the closed forms, as root mean squares over directions of the sphere.
PlateErrors errors(int nodes) {
  const OneGrainOnPlane scene;
  const Shape sphere = testing::sphere(radius, nodes);
  constexpr int directions = 40;
  PlateErrors sum{};
  for (int n = 0; n < directions; ++n) {
    GrainState grain;
    grain.prescribed = true;
    grain.position = {0, 0, radius - overlap};
    grain.orientation = normalized(
        Quaternion{std::cos(1.0 * n), std::sin(2.3 * n), std::cos(3.7 * n), std::sin(5.1 * n)});
    grain.velocity = {1e6, 0, 0};  // slips at once: k_s A v dt is far above the cap
    Simulation simulation = scene.simulation(sphere, grain);
    simulation.step();  // the springs form; the overlap stays
    static_cast<void>(simulation.measure());
    const WallForce& force = simulation.wall_contacts().forces()[0];
    const auto square = [](double x) { return x * x; };
    sum.normal += square(force.force.z / normal_force - 1);
    sum.friction += square(-force.force.x / (0.5 * normal_force) - 1);
    sum.torque += square(force.moment.y / (0.5 * normal_force * (radius - overlap / 3)) - 1);
  }
  return {std::sqrt(sum.normal / directions), std::sqrt(sum.friction / directions),
          std::sqrt(sum.torque / directions)};
}

TEST(SphereOnPlate, ForceFrictionAndTorqueConvergeWithTheNodes) {
  testing::VerificationTable table{"sphere_on_plate", "nodes,normal_force,friction,torque"};
  std::vector<double> normal;
  for (const int nodes : {100, 200, 400, 800, 1600, 3200}) {
    const PlateErrors e = errors(nodes);
    table.row({static_cast<double>(nodes), e.normal, e.friction, e.torque});
    normal.push_back(e.normal);
    EXPECT_NEAR(e.friction, e.normal, 1e-9);  // full slip: the share mu of each node's push
  }
  EXPECT_LT(normal.back(), 0.02);
  // First order or better in 1/N over five doublings.
  EXPECT_GT(std::log2(normal.front() / normal.back()), 4.5);
}

TEST(SphereOnPlate, UndampedDropReturnsItsHeight) {
  OneGrainOnPlane scene;
  scene.gravity = {0, 0, -9.81};
  scene.friction = 0;
  GrainState grain;
  grain.position = {0, 0, 1.5};
  Simulation simulation = scene.simulation(testing::sphere(radius, 3200), grain);
  testing::run_until(simulation, 0.4);
  double apex = 0;
  while (simulation.time() < 1.0) {
    simulation.step();
    apex = std::max(apex, simulation.grains().position[0].z);
  }
  EXPECT_NEAR(apex - radius, 0.5, 0.005);
}

TEST(SphereOnPlate, ViscousDropReboundsToThePublishedHeight) {
  OneGrainOnPlane scene;
  scene.gravity = {0, 0, -9.81};
  scene.friction = 0;
  scene.law.viscosity = 1e6;
  GrainState grain;
  grain.position = {0, 0, 1.5};
  Simulation simulation = scene.simulation(testing::sphere(radius, 3200), grain);
  testing::run_until(simulation, 0.4);
  double apex = 0;
  while (simulation.time() < 0.8) {
    simulation.step();
    apex = std::max(apex, simulation.grains().position[0].z);
  }
  EXPECT_NEAR(apex - radius, 0.0884, 0.002);
}

}  // namespace
}  // namespace reckon
