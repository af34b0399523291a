// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// Spheres of law `hertz`, whose radius of contact is measured from the nodes that touch, against
// Hertz's force 4/3 E* sqrt(R*) d^(3/2).
#include <gtest/gtest.h>

#include <cmath>

#include "reckon/simulation/simulation.hpp"
#include "support/test_shapes.hpp"
#include "support/verification_table.hpp"

namespace reckon {
namespace {

constexpr double radius = 1;
constexpr double overlap = 0.05;
constexpr double young = 1e8;
constexpr double poisson = 0.25;

double hertz_force(double modulus, double effective_radius) {
  return 4.0 / 3 * modulus * std::sqrt(effective_radius) * std::pow(overlap, 1.5);
}

struct Errors {
  double on_plate;
  double on_sphere;
};

/// Root mean squares of the relative errors over directions of the spheres.
Errors errors(int nodes) {
  SimulationSetup setup;
  setup.shapes = testing::library_of({testing::sphere(radius, nodes)});
  setup.density = 2500;
  setup.contact = {hertz_law(young, poisson, false, 0), 0.5, MasterRule::both};
  const HertzLaw on_wall = hertz_law(young, poisson, true, 0);
  setup.walls = {{"floor", PlaneSurface{{0, 0, 0}, {0, 0, 1}}, on_wall, 0.5, false, {}}};
  setup.time_step = 1e-5;
  setup.skin = 0.1;
  Errors sum{};
  constexpr int directions = 20;
  for (int n = 0; n < directions; ++n) {
    SimulationState state;
    state.grains.resize(2);
    for (std::uint32_t g = 0; g < 2; ++g) {
      GrainState& grain = state.grains[g];
      grain.id = GrainId{g};
      grain.position = {0, 0, (radius - overlap) + g * (2 * radius - overlap)};
      const double turn = n + 0.5 * g;
      grain.orientation = normalized(Quaternion{std::cos(turn), std::sin(2.3 * turn),
                                                std::cos(3.7 * turn), std::sin(5.1 * turn)});
    }
    Simulation simulation{setup, state};
    (void)simulation.measure();
    const double plate = simulation.wall_contacts().forces()[0].force.z;
    const double pair = -simulation.grain_contacts().forces()[0].force_on_a.z;
    const auto square = [](double x) { return x * x; };
    sum.on_plate += square(plate / hertz_force(on_wall.normal_modulus, radius) - 1);
    sum.on_sphere += square(pair / hertz_force(0.5 * on_wall.normal_modulus, radius / 2) - 1);
  }
  return {std::sqrt(sum.on_plate / directions), std::sqrt(sum.on_sphere / directions)};
}

TEST(Hertz, SpheresOnPlateAndOnSphereConvergeToHertzsForce) {
  testing::VerificationTable table{"hertz", "nodes,on_plate,on_sphere"};
  std::vector<Errors> found;
  for (const int nodes : {400, 1600, 6400}) {
    found.push_back(errors(nodes));
    table.row({static_cast<double>(nodes), found.back().on_plate, found.back().on_sphere});
  }
  EXPECT_LT(found.back().on_plate, 0.02);
  EXPECT_LT(found.back().on_sphere, 0.04);
  EXPECT_LT(found.back().on_plate, 0.5 * found.front().on_plate);
}

}  // namespace
}  // namespace reckon
