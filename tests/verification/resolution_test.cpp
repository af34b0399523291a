// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// Contacts between grains of very different size, and of corners and edges, in any order of the
// grains: nothing may pass through or sink in.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "reckon/simulation/simulation.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

/// Puts grains, whose ids follow from their place here or from the end, into a simulation.
Simulation simulation_of(SimulationSetup setup, std::vector<GrainState> grains, bool reversed) {
  if (reversed) std::reverse(grains.begin(), grains.end());
  for (std::uint32_t n = 0; n < grains.size(); ++n) grains[n].id = GrainId{n};
  SimulationState state;
  state.grains = std::move(grains);
  return {std::move(setup), std::move(state)};
}

/// Small grains are thrown at a fixed slab of eight by eight nodes; how many end below its face.
int fallen_through(double ratio, bool slab_last) {
  const double small = 1 / ratio;
  SimulationSetup setup;
  setup.shapes = testing::library_of(
      {testing::box({1, 1, 0.5}, 8, 0.1), testing::bumpy_grain(small, 150, 16)});
  setup.density = 1000;
  const AreaLaw law{2e7, 2e7, area_dashpot_factor(0.5)};
  setup.contact = {law, 0.3};
  setup.time_step = 0.05 * std::sqrt(1000 * small * small * small / (2e7 * small * small));
  setup.skin = 0.1 * small;
  std::vector<GrainState> grains(1);
  grains[0].prescribed = true;
  for (int n = 0; n < 9; ++n) {
    GrainState grain;
    grain.shape = ShapeId{1};
    const int row = n / 3;
    grain.position = {0.55 * (n % 3 - 1) + 0.03, 0.55 * (row - 1) - 0.04, 0.5 + 1.3 * small};
    grain.velocity = {0, 0, -1};
    grains.push_back(grain);
  }
  Simulation simulation = simulation_of(setup, grains, slab_last);
  for (int n = 0; n < 2000; ++n) simulation.step();
  const Grains& after = simulation.grains();
  int fallen = 0;
  for (std::size_t slot = 0; slot < after.size(); ++slot) {
    if (after.prescribed[slot] == 0 && after.position[slot].z < 0.5) ++fallen;
  }
  return fallen;
}

TEST(SizeRatio, SmallGrainsDoNotPassThroughLargeOnesInAnyOrder) {
  for (const double ratio : {3.0, 7.0, 11.0, 30.0}) {
    for (const bool slab_last : {false, true}) {
      EXPECT_EQ(fallen_through(ratio, slab_last), 0) << ratio << (slab_last ? ", slab last" : "");
    }
  }
}

/// How deep a cube sinks into a fixed one like it, standing on a corner or an edge.
double sunk(const Quaternion& orientation, double reach, bool fixed_last) {
  SimulationSetup setup;
  const int per_edge = 20;
  setup.shapes = testing::library_of({testing::box({1, 1, 1}, per_edge, 0.05)});
  setup.density = 2650;
  setup.contact = {AreaLaw{1e10, 1e10, area_dashpot_factor(0.2)}, 0.5};
  setup.body_force.gravity = {0, 0, -9.81};
  setup.damping = 30;
  setup.time_step = 5e-4;
  setup.skin = 0.1;
  std::vector<GrainState> grains(2);
  grains[0].prescribed = true;
  grains[1].position = {0.05, 0.03, 1 + reach};
  grains[1].orientation = orientation;
  Simulation simulation = simulation_of(setup, grains, fixed_last);
  for (int n = 0; n < 2000; ++n) simulation.step();
  return 1 + reach - simulation.state().grains[fixed_last ? 0 : 1].position.z;
}

TEST(CornersAndEdges, RestOnFacesAndEachOtherInAnyOrder) {
  // Its nodes end half a spacing, 0.05, from its edges; a corner's reach 0.05 sqrt(3) from its tip.
  const double half = std::acos(1 / std::sqrt(3.0)) / 2;
  const Quaternion on_corner = normalized(Quaternion{
      std::cos(half), std::sin(half) / std::sqrt(2.0), -std::sin(half) / std::sqrt(2.0), 0});
  const Quaternion on_edge =
      normalized(Quaternion{std::cos(std::numbers::pi / 8), std::sin(std::numbers::pi / 8), 0, 0});
  const double corner = sunk(on_corner, std::sqrt(3.0), false);
  EXPECT_LT(corner, 0.13);
  EXPECT_NEAR(sunk(on_corner, std::sqrt(3.0), true), corner, 1e-9);
  const double edge = sunk(on_edge, std::sqrt(2.0), false);
  EXPECT_LT(edge, 0.10);
  EXPECT_NEAR(sunk(on_edge, std::sqrt(2.0), true), edge, 1e-9);
}

/// Grains of three sizes fall onto each other; the result does not depend on their order.
TEST(OrderOfGrains, DoesNotChangeTheAnswer) {
  for (const AnyContactLaw& law : {AnyContactLaw{AreaLaw{2e7, 2e7, area_dashpot_factor(0.5)}},
                                   AnyContactLaw{hertz_law(2e7, 0.2, false, 0.2)}}) {
    SimulationSetup setup;
    setup.shapes =
        testing::library_of({testing::bumpy_grain(1.0, 200, 16), testing::bumpy_grain(0.3, 150, 16),
                             testing::sphere(0.5, 150), testing::box({0.5, 0.6, 0.7}, 7, 0.1)});
    setup.density = 1000;
    setup.contact = {law, 0.4};
    setup.walls = {{"floor", PlaneSurface{{0, 0, 0}, {0, 0, 1}}, law, 0.4, false, {}}};
    setup.body_force.gravity = {0, 0, -9.81};
    setup.time_step = 3e-4;
    setup.skin = 0.1;
    std::vector<GrainState> grains;
    for (int n = 0; n < 36; ++n) {
      GrainState grain;
      grain.shape = ShapeId{static_cast<std::uint32_t>(n % 4)};
      const int layer = n / 9;
      grain.position = {1.1 * (n % 3), 1.1 * (n / 3 % 3), 0.8 + 1.3 * layer};
      grain.orientation = normalized(Quaternion{1, std::sin(1.0 * n), std::cos(2.0 * n), 0.3});
      grain.velocity = {0.1 * std::sin(3.0 * n), 0.1 * std::cos(5.0 * n), -1};
      grains.push_back(grain);
    }
    Simulation forward = simulation_of(setup, grains, false);
    Simulation backward = simulation_of(setup, grains, true);
    double deepest = 0;
    for (int n = 0; n < 400; ++n) {
      forward.step();
      backward.step();
      if (n % 100 == 0) deepest = std::max(deepest, forward.measure().deepest_overlap);
    }
    EXPECT_GT(deepest, 0.001);
    const auto first = forward.state().grains;
    const auto second = backward.state().grains;
    for (std::size_t n = 0; n < first.size(); ++n) {
      const GrainState& other = second[first.size() - 1 - n];
      EXPECT_LT(norm(first[n].position - other.position), 1e-8) << n;
      EXPECT_LT(norm(first[n].velocity - other.velocity), 1e-5) << n;
    }
  }
}

}  // namespace
}  // namespace reckon
