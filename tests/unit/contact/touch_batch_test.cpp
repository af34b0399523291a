// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/touch_batch.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "reckon/core/random.hpp"

namespace reckon {
namespace {

constexpr double dt = 1e-4;

/// One master and slave with some touching nodes, some flat; older springs on some of those and on
/// nodes that let go.
struct Meeting {
  PairContext context{.effective_mass = 0.3, .friction = 0.4, .time_step = dt};
  Vec3 center;
  RigidMotion master, slave;
  std::vector<Touch> touches;
  std::vector<NodeSpring> old_springs;

  explicit Meeting(std::uint64_t subject) {
    RandomStream random{7, RandomPurpose::other, subject};
    const auto vector = [&](double size) {
      return Vec3{random.uniform(-size, size), random.uniform(-size, size),
                  random.uniform(-size, size)};
    };
    center = vector(1);
    master = {center, vector(2), vector(3)};
    slave = {vector(1), vector(2), vector(3)};
    for (NodeIndex node = 0; node < 19; ++node) {
      const bool touches_now = random.uniform() < 0.4;
      const bool is_flat = random.uniform() < 0.1;
      if (touches_now) {
        touches.push_back({node, -random.uniform(0, 1e-3), is_flat ? Vec3{} : vector(1), vector(1),
                           random.uniform(0, 1e-2)});
      }
      // Some springs lie against today's normal, some will slide, some will not.
      if (random.uniform() < 0.5) {
        old_springs.push_back({node, false, vector(random.uniform() < 0.5 ? 1 : 1e3),
                               is_flat || !touches_now ? normalized(vector(1))
                                                       : normalized(-touches.back().gradient_world),
                               random.uniform(-10, 10),
                               random.uniform() < 0.2 ? 0 : random.uniform(1e-3, 1e3)});
      }
    }
  }
};

std::array<std::uint64_t, 14> bits(const DirectedForce& f) {
  const auto of = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return {of(f.force.x),         of(f.force.y),
          of(f.force.z),         of(f.moment_master.x),
          of(f.moment_master.y), of(f.moment_master.z),
          of(f.moment_slave.x),  of(f.moment_slave.y),
          of(f.moment_slave.z),  of(f.deepest),
          of(f.elastic),         of(f.friction),
          of(f.dashpot),         f.touching};
}

template <class Law>
void expect_same_bits(const Law& law) {
  std::vector<Meeting> meetings;
  for (std::uint64_t m = 0; m < 60; ++m) meetings.emplace_back(m);
  for (const SimdLevel level : simd_levels_here()) {
    SCOPED_TRACE(name_of(level));
    TouchBatch batch;
    for (int round = 0; round < 2; ++round) {  // the second finds the first's lanes
      batch.clear();
      for (const Meeting& m : meetings) {
        batch.add(m.context, m.center, m.master, m.slave, m.touches, m.old_springs);
      }
      batch.evaluate(law, meetings[0].context.friction, dt, law_lanes(level));
      for (std::size_t n = 0; n < meetings.size(); ++n) {
        const Meeting& m = meetings[n];
        std::vector<NodeSpring> expected_springs;
        std::vector<NodeSpring> springs;
        const DirectedForce expected =
            pair_force(law, m.context, m.center, m.master, m.slave, m.touches, m.old_springs, true,
                       0.5, expected_springs);
        const DirectedForce found = batch.sum(n, law, m.old_springs, true, 0.5, springs);
        ASSERT_EQ(bits(found), bits(expected)) << n;
        ASSERT_EQ(springs, expected_springs) << n;
      }
    }
  }
}

TEST(TouchBatch, LinearLawAnswersAsOneNodeAfterTheOther) {
  expect_same_bits(LinearLaw{1e5, 9e4, 0.3, 4});
  expect_same_bits(LinearLaw{1e5, 9e4, 0, 0});
}

TEST(TouchBatch, HertzLawAnswersAsOneNodeAfterTheOther) {
  expect_same_bits(hertz_law(1e8, 0.2, false, 0.3));
  expect_same_bits(hertz_law(1e8, 0.2, false, 0));
}

TEST(TouchBatch, AreaLawAnswersAsOneNodeAfterTheOther) {
  expect_same_bits(AreaLaw{1e8, 5e7, 0.3, 2e4});
  expect_same_bits(AreaLaw{1e8, 5e7, 0, 0});
}

}  // namespace
}  // namespace reckon
