// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/membrane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

constexpr double radius = 0.5;
constexpr double height = 1.2;
constexpr double spacing = 0.05;
constexpr double sheet = 900;  // Young's modulus times thickness [N/m]
constexpr double dt = 1e-3;
const WallId mould{0};
const WallId floor_wall{1};
const WallId lid{2};
const CylinderPlace place{{0.1, -0.2, 0.3}, {0, 0, 1}, radius, height};

MembraneSetup rubber(MembraneEnds ends) {
  MembraneSetup setup;
  setup.mould = mould;
  setup.spacing = spacing;
  setup.bond_stiffness = membrane_bond_stiffness(sheet);
  setup.ends = ends;
  setup.damping = 20;
  setup.areal_mass = membrane_areal_mass(setup, 200, dt, 0.5);
  return setup;
}

Membrane placed(MembraneEnds ends, const CylinderPlace& where = place) {
  Membrane membrane{rubber(ends)};
  membrane.take_place(where, floor_wall, lid, std::vector<WallPose>(3));
  return membrane;
}

/// Lets it come to rest under a pressure.
void settle(Membrane& membrane, double pressure, std::vector<WallPose> poses, int steps = 2500) {
  set_thread_count(1);  // so small a sheet is not worth waking others
  for (int n = 0; n < steps; ++n) {
    membrane.follow(poses);
    membrane.evaluate({}, pressure);
    membrane.advance(dt);
  }
  membrane.follow(poses);
  membrane.evaluate({}, pressure);
}

double mean_radius(const Membrane& membrane, std::uint32_t ring) {
  double sum = 0;
  for (std::uint32_t c = 0; c < membrane.mesh().columns(); ++c) {
    const Vec3 p = membrane.nodes()[ring * membrane.mesh().columns() + c].position - place.foot;
    sum += std::hypot(p.x, p.y) / membrane.mesh().columns();
  }
  return sum;
}

TEST(MembraneMesh, NeighborsNameEachOtherAndShareBonds) {
  const MembraneMesh mesh{place, spacing};
  for (std::uint32_t n = 0; n < mesh.size(); ++n) {
    const auto around = mesh.neighbors(n);
    for (std::size_t k = 0; k < 6; ++k) {
      if (around[k] == MembraneMesh::none) {
        EXPECT_TRUE(mesh.is_end(n));
        continue;
      }
      EXPECT_EQ(mesh.neighbors(around[k])[(k + 3) % 6], n);
      const double rest = k % 3 == 0 ? mesh.ring_bond() : mesh.cross_bond();
      EXPECT_NEAR(norm(mesh.places()[n] - mesh.places()[around[k]]), rest, 1e-14);
    }
  }
  EXPECT_NEAR(mesh.cross_bond() / mesh.ring_bond(), 1, 0.02);
}

TEST(MembraneMesh, AreasSumToThePolygonalCylinder) {
  const MembraneMesh mesh{place, spacing};
  double sum = 0;
  for (std::uint32_t n = 0; n < mesh.size(); ++n) sum += mesh.area(n);
  EXPECT_NEAR(sum, 2 * std::numbers::pi * radius * height, 2e-3 * sum);
}

TEST(Membrane, RestsWithoutForceAndEnclosesTheCylinder) {
  const Membrane membrane = placed(MembraneEnds::sealed);
  for (std::uint32_t n = 0; n < membrane.mesh().size(); ++n) {
    EXPECT_LT(norm(membrane.force_on(n)), 1e-11);
  }
  const Enclosure space = membrane.enclosure(3);
  const double columns = membrane.mesh().columns();
  const double polygon = 0.5 * columns * radius * radius * std::sin(2 * std::numbers::pi / columns);
  EXPECT_NEAR(space.volume, polygon * height, 1e-3 * space.volume);  // the strips are twisted
  EXPECT_NEAR(space.areas[lid.get()] * height, space.volume, 1e-14);
  EXPECT_NEAR(space.size().z, height, 1e-14);
}

TEST(Membrane, PressureIsMinusTheDerivativeOfItsWorkAndBalances) {
  Membrane membrane = placed(MembraneEnds::sealed);
  const double pressure = 70;
  membrane.evaluate({}, pressure);
  Vec3 sum;
  double inward = 0;
  for (std::uint32_t n = 0; n < membrane.mesh().size(); ++n) {
    sum += membrane.force_on(n);
    const Vec3 p = membrane.nodes()[n].position - place.foot;
    inward -= dot(membrane.force_on(n), normalized(Vec3{p.x, p.y, 0}));
  }
  EXPECT_LT(norm(sum), 1e-11);
  EXPECT_NEAR(inward, pressure * 2 * std::numbers::pi * radius * height, 2e-3 * inward);

  // One inner node a little out: the volume grows by force over pressure.
  MembraneState state = membrane.state();
  const std::uint32_t node = 5 * membrane.mesh().columns() + 7;
  const Vec3 way{1e-5, 2e-5, -1e-5};
  const Vec3 force = membrane.force_on(node);
  const double before = membrane.enclosure(3).volume;
  state.nodes[node].position += way;
  membrane.adopt(state);
  membrane.follow(std::vector<WallPose>(3));
  membrane.evaluate({}, pressure);
  EXPECT_NEAR((membrane.enclosure(3).volume - before) * -pressure, dot(force, way),
              1e-4 * std::abs(dot(force, way)));
}

/// Inner pressure p against the hoop: T = p r, T = C e, with C = E t / (1 - 1/9) at no axial
/// strain.
TEST(Membrane, HoopTensionBalancesInnerPressure) {
  Membrane membrane = placed(MembraneEnds::sliding);
  const double pressure = 20;  // 1 % of strain
  settle(membrane, -pressure, std::vector<WallPose>(3));
  const double stiffness = sheet / (1 - 1.0 / 9);
  const std::uint32_t middle = membrane.mesh().rings() / 2;
  const double r = mean_radius(membrane, middle);
  const double strain = r / radius - 1;
  EXPECT_NEAR(strain, pressure * r / stiffness, 0.03 * strain);
  for (std::uint32_t ring = 0; ring < membrane.mesh().rings(); ++ring) {
    EXPECT_NEAR(mean_radius(membrane, ring), r, 2e-4 * r) << ring;
  }
  for (std::uint32_t n = 0; n < membrane.mesh().size(); ++n) {
    EXPECT_LT(norm(membrane.nodes()[n].velocity), 1e-6);
  }
}

/// The planes part: axial force over circumference is C e, and hoop tension is a third of it, which
/// an inner pressure must balance to keep the radius.
TEST(Membrane, UniaxialStrainHasTheStatedStiffness) {
  Membrane membrane = placed(MembraneEnds::sliding);
  const double strain = 0.01;
  std::vector<WallPose> poses(3);
  poses[lid.get()].displacement = {0, 0, strain * height};
  const double stiffness = sheet / (1 - 1.0 / 9);
  settle(membrane, -stiffness * strain / 3 / radius, poses);
  EXPECT_NEAR(mean_radius(membrane, membrane.mesh().rings() / 2), radius, 2e-4 * radius);
  double axial = 0;
  const auto last = static_cast<std::uint32_t>(membrane.mesh().size()) - membrane.mesh().columns();
  for (std::uint32_t c = 0; c < membrane.mesh().columns(); ++c) {
    axial -= membrane.force_on(last + c).z;
  }
  const double expected = stiffness * strain * 2 * std::numbers::pi * radius;
  EXPECT_NEAR(axial, expected, 0.03 * expected);
}

TEST(Membrane, DoesNotPush) {
  Membrane membrane = placed(MembraneEnds::sealed);
  std::vector<WallPose> poses(3);
  poses[lid.get()].displacement = {0, 0, -0.1 * height};
  MembraneState state = membrane.state();
  for (MembraneNode& node : state.nodes) node.position.z = 0.3 + 0.9 * (node.position.z - 0.3);
  membrane.adopt(state);
  membrane.follow(poses);
  membrane.evaluate({}, 0);
  for (std::uint32_t n = 0; n < membrane.mesh().size(); ++n) {
    EXPECT_LT(norm(membrane.force_on(n)), 1e-11);
  }
}

TEST(Membrane, EnergyOfASwingBalances) {
  MembraneSetup setup = rubber(MembraneEnds::sealed);
  setup.damping = 1;
  Membrane membrane{setup};
  std::vector<WallPose> poses(3);
  membrane.take_place(place, floor_wall, lid, poses);
  const auto balance = [&](double& turnover) {
    double total = 0;
    for (std::uint32_t n = 0; n < membrane.mesh().size(); ++n) {
      const EnergyLedger ledger = membrane.ledger(n);
      total += membrane.kinetic_energy(n, dt) + membrane.bond_energy(n) + ledger.damping -
               ledger.wall_work;
      turnover += std::abs(ledger.wall_work);
    }
    return total;
  };
  // Pressure from inside, while the lid is pulled up and aside.
  for (int n = 1; n <= 800; ++n) {
    poses[lid.get()].velocity = n > 10 ? Vec3{0.02, 0, 0.05} : Vec3{};
    poses[lid.get()].displacement += dt * poses[lid.get()].velocity;
    membrane.follow(poses);
    membrane.evaluate({}, -30);
    membrane.advance(dt);
  }
  membrane.follow(poses);
  membrane.evaluate({}, -30);
  double turnover = 0;
  const double error = balance(turnover);
  EXPECT_NEAR(error, 0, 0.01 * turnover);
  EXPECT_GT(turnover, 0.1);
}

TEST(Membrane, StaysStableAtTheMassChosenForTheTimeStep) {
  Membrane membrane = placed(MembraneEnds::sealed);
  MembraneState state = membrane.state();
  for (std::size_t n = 0; n < state.nodes.size(); ++n) {  // the stiffest pattern there is
    state.nodes[n].velocity = {n % 2 == 0 ? 0.5 : -0.5, n % 3 == 0 ? 0.5 : -0.5, 0};
  }
  membrane.adopt(state);
  settle(membrane, 0, std::vector<WallPose>(3), 3000);
  for (const MembraneNode& node : membrane.nodes()) EXPECT_LT(norm(node.velocity), 1e-3);
}

TEST(Membrane, RefusesAStateOfAnotherMesh) {
  MembraneState state = placed(MembraneEnds::sealed).state();
  state.nodes.pop_back();
  Membrane membrane{rubber(MembraneEnds::sealed)};
  EXPECT_THROW(membrane.adopt(state), Error);
  state = placed(MembraneEnds::sealed).state();
  state.springs.push_back({1u << 30, GrainId{0}, {}, {}});
  EXPECT_THROW(membrane.adopt(state), Error);
}

}  // namespace
}  // namespace reckon
