// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reckon/analysis/sample.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/random.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/simulation.hpp"
#include "support/same_state.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

using testing::expect_same_state;

constexpr double density = 2000;
constexpr double pitch = 2.25;
constexpr int per_edge = 4;
constexpr double edge = per_edge * pitch;

SimulationSetup setup_in_cell() {
  SimulationSetup setup;
  setup.shapes =
      testing::library_of({testing::bumpy_grain(1.0, 200, 16), testing::bumpy_grain(0.8, 150, 16)});
  setup.density = density;
  setup.contact = {AreaLaw{2e7, 1.5e7, area_dashpot_factor(0.6)}, 0.4, MasterRule::lower_id};
  setup.cell = CellSetup{.center = {1, 2, 3}, .size = {edge, edge, edge}};
  setup.time_step = 3e-4;
  setup.skin = 0.05;
  return setup;
}

/// Grains on a grid through the cell, moving at random. They need not lie within it.
SimulationState loose_grains(double speed, const Vec3& shift = {}) {
  SimulationState state;
  RandomStream random{3, RandomPurpose::other, 1};
  for (std::uint32_t n = 0; n < per_edge * per_edge * per_edge; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    grain.shape = ShapeId{n % 2};
    grain.position = shift + pitch * Vec3{n % 4 + 0.0, n / 4 % 4 + 0.0, std::floor(n / 16.0)};
    for (int axis = 0; axis < 3; ++axis) {
      grain.velocity[axis] = random.uniform(-speed, speed);
      grain.angular_velocity_body[axis] = random.uniform(-speed, speed);
    }
    state.grains.push_back(grain);
  }
  return state;
}

StageSetup stage(std::vector<CellControl> controls) {
  return {.name = "stage", .friction = 0.4, .damping = 1, .cell_controls = std::move(controls)};
}

std::vector<CellControl> pressure(double stress) {
  std::vector<CellControl> controls;
  for (const CellAxis axis : {CellAxis::x, CellAxis::y, CellAxis::z}) {
    controls.push_back({.axis = axis, .value = stress, .rate_limit = 2});
  }
  return controls;
}

/// Pressed from all sides, then sheared while the pressure is held along y.
SimulationSetup press_and_shear() {
  SimulationSetup setup = setup_in_cell();
  setup.stages = {
      stage(pressure(2e4)),
      stage({{.axis = CellAxis::y, .value = 2e4, .rate_limit = 2},
             {.axis = CellAxis::z, .target = WallTarget::strain_rate, .value = 0.2},
             {.axis = CellAxis::xy, .target = WallTarget::strain_rate, .value = 2},
             {.axis = CellAxis::xz, .target = WallTarget::strain_rate, .value = 0.5},
             {.axis = CellAxis::yz, .target = WallTarget::strain_rate, .value = -0.3}})};
  return setup;
}

constexpr int pressing = 1200;
constexpr int shearing = 800;

void press_then_shear(Simulation& simulation, int from = 0, int to = pressing + shearing) {
  for (int n = from; n < to; ++n) {
    if (n == pressing) simulation.begin_next_stage();
    simulation.step();
  }
}

TEST(Cell, MapsAndStraightensALeaningLattice) {
  PeriodicCell cell{{1, 1, 1}, {true, true, true}, {{4, 5, 6}, 0, 0, 0}, {}};
  UpperMat3 rates;
  rates.xy = 30;  // six edges of x
  rates.xz = -7;
  rates.yz = 4;
  const Vec3 point{3.3, -7.1, 11.9};
  const Vec3 before = cell.fractions(point);
  const UpperMat3 gradient = cell.advance(rates, 1);
  const Vec3 after = point + gradient * (point - cell.center());
  EXPECT_LE(std::abs(cell.edges().xy), 2);
  EXPECT_LE(std::abs(cell.edges().xz), 2);
  EXPECT_LE(std::abs(cell.edges().yz), 2.5);
  // The same lattice: the edges that only moved are whole multiples of those taken instead.
  const UpperMat3 moved = UpperMat3{{4, 5, 6}, 0, 0, 0} + rates;
  EXPECT_LT(norm(after - cell.center() - moved * before), 1e-12);
  const UpperMat3 multiples = inverse(cell.edges()) * moved;
  EXPECT_EQ(multiples.diagonal, (Vec3{1, 1, 1}));
  for (const double number : {multiples.xy, multiples.xz, multiples.yz}) {
    EXPECT_NEAR(number, std::round(number), 1e-12);
  }
  EXPECT_LT(norm(cell.velocity_at(after) - rates * before), 1e-12);
}

TEST(Cell, PairsAreThoseOfAllImages) {
  PeriodicCell cell{{0.3, 0, 0}, {true, true, true}, {{10, 9, 8}, 3, -4, 2}, {}};
  RandomStream random{1, RandomPurpose::other, 1};
  std::vector<GrainId> ids;
  std::vector<Vec3> positions;
  std::vector<double> radii;
  for (std::uint32_t n = 0; n < 120; ++n) {
    ids.emplace_back(119 - n);
    radii.push_back(random.uniform(0.2, 0.9));
    Vec3& p = positions.emplace_back();
    for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(-40, 40);
  }
  constexpr double skin = 0.1;
  std::size_t expected = 0;
  for (std::size_t s = 0; s < ids.size(); ++s) {
    for (std::size_t t = s + 1; t < ids.size(); ++t) {
      const Vec3 home = cell.wrapped(positions[s]) - cell.wrapped(positions[t]);
      for (int n = 0; n < 343; ++n) {
        const Vec3 image{n % 7 - 3.0, n / 7 % 7 - 3.0, std::floor(n / 49.0) - 3};
        if (norm(home - cell.shift_of(image)) < radii[s] + radii[t] + skin) ++expected;
      }
    }
  }
  const auto plain = find_pairs_brute_force(ids, positions, radii, skin, ids.size(), &cell);
  const auto binned = find_pairs_in_cell(ids, positions, radii, skin, ids.size(), cell);
  EXPECT_GT(expected, 50U);
  EXPECT_EQ(plain.size(), expected);
  ASSERT_EQ(binned.size(), expected);
  for (std::size_t p = 0; p < binned.size(); ++p) {
    EXPECT_EQ(binned[p].id_a, plain[p].id_a);
    EXPECT_EQ(binned[p].id_b, plain[p].id_b);
  }
}

TEST(Cell, GrainsThatMeetAcrossTheBorderDoAsInTheMiddle) {
  SimulationSetup setup = setup_in_cell();
  setup.cell = CellSetup{.center = {8, 8, 8}, .size = {16, 16, 16}};
  const auto meet = [&](const Vec3& a, const Vec3& b) {
    SimulationState state;
    for (const Vec3& place : {a, b}) {
      GrainState grain;
      grain.id = GrainId{static_cast<std::uint32_t>(state.grains.size())};
      grain.position = place;
      grain.velocity = {state.grains.empty() ? 0.5 : -0.5, 0.1, 0.2};
      grain.angular_velocity_body = {0, 0.5, 2};
      state.grains.push_back(grain);
    }
    Simulation simulation{setup, state};
    for (int n = 0; n < 2000; ++n) simulation.step();
    EXPECT_GT(simulation.grain_contacts().counters().touching_nodes, 100U);
    return simulation.state();
  };
  const SimulationState middle = meet({7.25, 8, 8}, {9.25, 8.5, 8.25});
  const SimulationState across = meet({15.25, 15.75, 0.25}, {1.25, 16.25, 16.5});
  const SimulationState far = meet({15.25 - 160, 15.75, 0.25}, {1.25, 16.25, 16.5 + 320});
  const Vec3 start[2] = {{7.25, 8, 8}, {9.25, 8.5, 8.25}};
  const Vec3 start_across[2] = {{15.25, 15.75, 0.25}, {1.25, 16.25, 16.5}};
  const Vec3 start_far[2] = {{15.25 - 160, 15.75, 0.25}, {1.25, 16.25, 16.5 + 320}};
  for (std::size_t g = 0; g < 2; ++g) {
    const Vec3 way = middle.grains[g].position - start[g];
    EXPECT_LT(norm(across.grains[g].position - start_across[g] - way), 1e-11);
    EXPECT_LT(norm(far.grains[g].position - start_far[g] - way), 1e-10);
    EXPECT_LT(norm(across.grains[g].velocity - middle.grains[g].velocity), 1e-10);
    EXPECT_LT(norm(across.grains[g].angular_velocity_body - middle.grains[g].angular_velocity_body),
              1e-10);
  }
}

/// Two cemented grains tug at each other.
TEST(Cell, CementHoldsAcrossTheBorderAsInTheMiddle) {
  SimulationSetup setup = setup_in_cell();
  setup.cell = CellSetup{.center = {8, 8, 8}, .size = {16, 16, 16}};
  setup.contact.bond = BondLaw{2e7, 1e7, 4e6, 4e6, 0.5};
  setup.stages = {stage({})};
  setup.stages[0].sets_bonds = true;
  const auto tug = [&](const Vec3& a, const Vec3& b) {
    SimulationState state;
    for (const Vec3& place : {a, b}) {
      GrainState grain;
      grain.id = GrainId{static_cast<std::uint32_t>(state.grains.size())};
      grain.position = place;
      grain.velocity = {state.grains.empty() ? -0.3 : 0.3, 0.1, 0.2};
      grain.angular_velocity_body = {0, 0.05, 0.2};
      state.grains.push_back(grain);
    }
    Simulation simulation{setup, state};
    for (int n = 0; n < 1000; ++n) simulation.step();
    EXPECT_EQ(simulation.measure().bonds, 1U);
    EXPECT_GT(simulation.measure().energy.elastic, 0);
    return simulation.state();
  };
  const SimulationState middle = tug({7.25, 8, 8}, {8.75, 8.25, 8.25});
  const SimulationState across = tug({15.25, 15.75, 0.25}, {0.75, 0, 16.5});
  for (std::size_t g = 0; g < 2; ++g) {
    EXPECT_LT(norm(across.grains[g].velocity - middle.grains[g].velocity), 1e-9);
    EXPECT_LT(norm(across.grains[g].angular_velocity_body - middle.grains[g].angular_velocity_body),
              1e-9);
  }
}

TEST(Cell, FreeGrainsFollowThePrescribedDeformation) {
  SimulationSetup setup = setup_in_cell();
  setup.stages = {stage({{.axis = CellAxis::x, .target = WallTarget::strain_rate, .value = 0.1},
                         {.axis = CellAxis::z, .target = WallTarget::strain_rate, .value = -0.3},
                         {.axis = CellAxis::xy, .target = WallTarget::strain_rate, .value = 3}})};
  setup.contact.law = AreaLaw{1e-6, 1e-6, 0};  // what touches as planes slide does not matter
  const SimulationState start = loose_grains(0);
  Simulation simulation{setup, start};
  constexpr int steps = 1000;
  for (int n = 0; n < steps; ++n) simulation.step();
  const SimulationState end = simulation.state();
  UpperMat3 deformation = UpperMat3::identity();
  const UpperMat3 step{{1 - 3e-5, 1, 1 + 9e-5}, 9e-4, 0, 0};
  for (int n = 0; n < steps; ++n) deformation = step * deformation;
  const Vec3& center = setup.cell->center;
  for (std::size_t g = 0; g < end.grains.size(); ++g) {
    const Vec3 expected = center + deformation * (start.grains[g].position - center);
    EXPECT_LT(norm(end.grains[g].position - expected), 1e-9) << g;
  }
  EXPECT_NEAR(simulation.cell()->edges().diagonal.x, edge * deformation.diagonal.x, 1e-10);
  EXPECT_NEAR(simulation.cell()->edges().diagonal.z, edge * deformation.diagonal.z, 1e-10);
  EXPECT_NEAR(simulation.cell_state().shear.x, 3 * steps * setup.time_step, 1e-12);
  EXPECT_LE(std::abs(simulation.cell()->edges().xy), 0.5 * edge);
  EXPECT_LT(simulation.measure().energy.translation, 1e-9);
}

TEST(Cell, MomentumAndEnergyAreKept) {
  SimulationSetup setup = setup_in_cell();
  setup.contact.law = AreaLaw{2e7, 1.5e7, 0};
  Simulation simulation{setup, loose_grains(1)};
  const Measurement before = simulation.measure();
  for (int n = 0; n < 3000; ++n) simulation.step();
  const Measurement after = simulation.measure();
  EXPECT_GT(after.energy.friction, 0.02 * before.energy.total());
  EXPECT_LT(norm(after.momentum - before.momentum), 1e-9 * after.largest_speed * 64 * density);
  EXPECT_NEAR(after.energy.total(), before.energy.total(), 2e-3 * before.energy.total());
}

TEST(Cell, ServosHoldStressAndWorkIsAccountedFor) {
  Simulation simulation{press_and_shear(), loose_grains(0.5)};
  const double before = simulation.measure().energy.total();
  press_then_shear(simulation, 0, pressing);
  Measurement now = simulation.measure();
  SampleMeasurement sample = measure_sample(simulation);
  EXPECT_NEAR(sample.stress.row_x.x, 2e4, 2e2);
  EXPECT_NEAR(sample.stress.row_y.y, 2e4, 2e2);
  EXPECT_NEAR(sample.stress.row_z.z, 2e4, 2e2);
  EXPECT_NEAR(sample.stress.row_x.x,
              stress_of(CellAxis::x, simulation.cell_reaction(), *simulation.cell()), 1e-6);
  EXPECT_GT(now.energy.wall_work, 1e3);
  EXPECT_NEAR(now.energy.total(), before, 0.01 * now.energy.wall_work);
  press_then_shear(simulation, pressing);
  now = simulation.measure();
  sample = measure_sample(simulation);
  EXPECT_NEAR(sample.stress.row_y.y, 2e4, 1e3);
  EXPECT_LT(sample.stress.row_x.y, -2e3);  // resists
  EXPECT_NEAR(now.energy.total(), before, 0.01 * now.energy.wall_work);
}

/// Where the borders lie does not matter.
TEST(Cell, AShiftedOriginGivesTheSameSample) {
  const Vec3 shift{1.7, -20.3, 4.1};
  Simulation here{press_and_shear(), loose_grains(0.5)};
  Simulation there{press_and_shear(), loose_grains(0.5, shift)};
  press_then_shear(here, 0, 1000);
  press_then_shear(there, 0, 1000);
  const SimulationState a = here.state();
  const SimulationState b = there.state();
  const double x = here.cell()->edges().diagonal.x;
  EXPECT_NEAR(there.cell()->edges().diagonal.x, x, 1e-9 * x);
  EXPECT_NEAR(here.measure().energy.elastic, there.measure().energy.elastic,
              1e-6 * here.measure().energy.elastic);
  ASSERT_EQ(a.pair_springs.size(), b.pair_springs.size());
  EXPECT_GT(a.pair_springs.size(), 60U);
  for (std::size_t p = 0; p < a.pair_springs.size(); ++p) {
    EXPECT_EQ(a.pair_springs[p].id_a, b.pair_springs[p].id_a);
    EXPECT_EQ(a.pair_springs[p].id_b, b.pair_springs[p].id_b);
  }
}

TEST(Cell, EndsInTheSameBitsWithEveryEngineSkinAndRestart) {
  const int threads_before = thread_count();
  for (const MasterRule master : {MasterRule::lower_id, MasterRule::both}) {
    SimulationSetup setup = press_and_shear();
    setup.contact.master = master;
    setup.engine = ContactEngine::plain;
    set_thread_count(1);
    Simulation plain{setup, loose_grains(0.5)};
    press_then_shear(plain);
    const SimulationState expected = plain.state();
    const Measurement measured = plain.measure();
    setup.engine = ContactEngine::near;
    for (const double skin : {0.004, 0.05}) {
      for (const SimdLevel simd : {SimdLevel::scalar, simd_levels_here().back()}) {
        // One dimension at a time.
        if ((skin < 0.01 || master == MasterRule::both) != (simd == SimdLevel::scalar)) continue;
        setup.skin = skin;
        setup.simd = simd;
        set_thread_count(skin > 0.01 ? 2 : 1);
        Simulation first{setup, loose_grains(0.5)};
        for (int n = 0; n < 777; ++n) {
          if (n % 13 == 0) static_cast<void>(first.measure());
          first.step();
        }
        Simulation second{setup, first.state()};
        press_then_shear(second, 777);
        expect_same_state(second.state(), expected);
        EXPECT_EQ(second.state().cell, expected.cell);
        EXPECT_EQ(second.measure(), measured);
        const ContactCounters& counters = second.grain_contacts().counters();
        EXPECT_LT(counters.due, counters.pairs / 10 * 9);
        if (::testing::Test::HasFailure()) break;
      }
    }
    EXPECT_GT(expected.pair_springs.size(), 60U);
  }
  set_thread_count(threads_before);
}

TEST(Cell, ThatIsTooNarrowIsRefused) {
  SimulationSetup setup = setup_in_cell();
  setup.cell->size.z = 4;
  Simulation simulation{setup, loose_grains(0)};
  try {
    simulation.step();
    FAIL() << "was not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string{error.what()}.find("two images"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace reckon
