// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/grain_contacts.hpp"

#include <gtest/gtest.h>

#include <random>

#include "reckon/parallel/threads.hpp"
#include "support/list_pairs.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

/// Two bumpy grains, a little overlapping, with velocities; `shift` moves the second one.
class TwoGrains : public ::testing::Test {
 protected:
  std::vector<GrainFrame> frames(const Vec3& shift = {}, const Vec3& turn = {}) const {
    Grains grains;
    GrainState a;
    a.id = GrainId{3};
    a.orientation = normalized(Quaternion{0.9, 0.1, -0.3, 0.2});
    a.velocity = {0.1, 0.2, -0.1};
    a.angular_velocity_body = {1, 2, 3};
    GrainState b;
    b.id = GrainId{8};
    b.position = Vec3{1.62, 0.1, 0.05} + shift;
    const Quaternion half_turn{1, 0.5 * turn.x, 0.5 * turn.y, 0.5 * turn.z};
    b.orientation = normalized(half_turn * normalized(Quaternion{0.2, 0.4, 0.1, -0.8}));
    b.angular_velocity_body = {-2, 0.5, 1};
    grains.push_back(a);
    grains.push_back(b);
    std::vector<GrainFrame> result;
    update_frames(grains, views_, 2000, result);
    return result;
  }

  PairForce force(GrainContacts& contacts, const std::vector<GrainFrame>& at) const {
    testing::list_pairs(contacts, at, 0.5);
    contacts.evaluate(at, 1e-5);
    return contacts.forces()[0];
  }

  Shape shape_ = testing::bumpy_grain(1.0, 2000);
  std::vector<ShapeView> views_{ShapeView{shape_}};
};

TEST_F(TwoGrains, AreaLawIsTheGradientOfItsEnergy) {
  for (const MasterRule master : {MasterRule::lower_id, MasterRule::both}) {
    GrainContacts contacts{{AreaLaw{1e6, 1e6, 0}, 0, master}};
    const PairForce here = force(contacts, frames());
    ASSERT_GT(here.touching, 20U);
    const double h = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 shift;
      shift[axis] = h;
      const double energy_plus = force(contacts, frames(shift)).elastic;
      const double energy_minus = force(contacts, frames(-shift)).elastic;
      // Moving b by +h: the force on b is -dE/dh, and that on a its opposite.
      EXPECT_NEAR(here.force_on_a[axis], (energy_plus - energy_minus) / (2 * h),
                  1e-4 * norm(here.force_on_a));
      const double turned_plus = force(contacts, frames({}, shift)).elastic;
      const double turned_minus = force(contacts, frames({}, -shift)).elastic;
      EXPECT_NEAR(here.moment_b[axis], -(turned_plus - turned_minus) / (2 * h),
                  1e-4 * norm(here.moment_b) + 1e-4 * norm(here.force_on_a));
    }
  }
}

TEST_F(TwoGrains, ActionAndReactionBalanceInForceAndMoment) {
  GrainContacts contacts{{LinearLaw{1e4, 9e3, 0.3, 0}, 0.6, MasterRule::lower_id}};
  const auto at = frames();
  const PairForce pair = force(contacts, at);
  ASSERT_GT(pair.touching, 20U);
  // Moments of both sides about one point cancel: M_a + M_b + (x_b - x_a) x (-F) = 0.
  const Vec3 total =
      pair.moment_a + pair.moment_b - cross(at[1].position - at[0].position, pair.force_on_a);
  EXPECT_LT(norm(total), 1e-12 * norm(pair.moment_a));
}

TEST_F(TwoGrains, SpringsAreKeptWhileTouchingAndDroppedOnSeparation) {
  GrainContacts contacts{{AreaLaw{1e6, 1e6, 0}, 0.5, MasterRule::lower_id}};
  force(contacts, frames());
  contacts.commit();
  const auto first = contacts.springs();
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].id_a, GrainId{3});
  EXPECT_EQ(first[0].springs.size(), contacts.forces()[0].touching);

  force(contacts, frames());  // one more step in place: springs grow with the same velocities
  contacts.commit();
  EXPECT_GT(norm(contacts.springs()[0].springs[3].shear_force),
            norm(first[0].springs[3].shear_force));

  const PairForce apart = force(contacts, frames({0.5, 0, 0}));
  contacts.commit();
  EXPECT_EQ(apart.touching, 0U);
  EXPECT_GT(apart.friction, 0);  // what the springs still held is lost
  EXPECT_TRUE(contacts.springs().empty());

  force(contacts, frames());
  contacts.commit();
  EXPECT_EQ(contacts.springs()[0].springs, first[0].springs);  // no memory of the first touch
}

TEST_F(TwoGrains, LookingWithoutCommitChangesNothing) {
  GrainContacts contacts{{AreaLaw{1e6, 1e6, 0}, 0.5, MasterRule::lower_id}};
  force(contacts, frames());
  contacts.commit();
  const auto before = contacts.springs();
  force(contacts, frames({0.01, 0, 0}));
  EXPECT_EQ(contacts.springs()[0].springs, before[0].springs);
}

TEST_F(TwoGrains, RestoredSpringsGoOnToTheSameBits) {
  GrainContacts original{{AreaLaw{1e6, 1e6, 0}, 0.5, MasterRule::both}};
  force(original, frames());
  original.commit();
  GrainContacts resumed{{AreaLaw{1e6, 1e6, 0}, 0.5, MasterRule::both}};
  resumed.adopt(original.springs());
  const PairForce expected = force(original, frames({0.001, 0, 0}));
  const PairForce actual = force(resumed, frames({0.001, 0, 0}));
  EXPECT_EQ(actual.force_on_a, expected.force_on_a);
  EXPECT_EQ(actual.moment_b, expected.moment_b);
  EXPECT_EQ(actual.friction, expected.friction);
}

TEST(MasterRule, SmallerGrainLendsItsNodes) {
  const Shape large = testing::sphere(1.0, 400);
  const Shape small = testing::sphere(0.3, 150);
  const std::vector<ShapeView> views{ShapeView{large}, ShapeView{small}};
  Grains grains;
  GrainState a;
  a.id = GrainId{0};
  GrainState b;
  b.id = GrainId{1};
  b.shape = ShapeId{1};
  b.position = {1.25, 0, 0};
  grains.push_back(a);
  grains.push_back(b);
  std::vector<GrainFrame> frames;
  update_frames(grains, views, 1, frames);
  GrainContacts contacts{{AreaLaw{1e6, 1e6, 0}, 0.5, MasterRule::smaller}};
  testing::list_pairs(contacts, frames, 0.1);
  contacts.evaluate(frames, 1e-5);
  contacts.commit();
  const auto springs = contacts.springs();
  ASSERT_EQ(springs.size(), 1U);
  for (const NodeSpring& spring : springs[0].springs) {
    EXPECT_TRUE(spring.master_is_b);
    EXPECT_LT(spring.node, 150U);
  }
  EXPECT_LT(contacts.forces()[0].force_on_a.x, 0);
}

TEST(GrainContacts, ThreadsDoNotChangeTheLoads) {
  const Shape shape = testing::bumpy_grain(1.0, 300);
  const std::vector<ShapeView> views{ShapeView{shape}};
  std::mt19937_64 random{5};
  std::uniform_real_distribution<double> place{0, 7};
  Grains grains;
  for (std::uint32_t n = 0; n < 150; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    grain.position = {place(random), place(random), place(random)};
    grain.orientation = normalized(Quaternion{place(random), place(random), 1, place(random)});
    grain.velocity = {place(random), 0, 1};
    grains.push_back(grain);
  }
  std::vector<GrainFrame> frames;
  update_frames(grains, views, 1000, frames);
  const int before = thread_count();
  std::vector<std::vector<Load>> loads;
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    GrainContacts contacts{{AreaLaw{1e6, 1e6, 0.2}, 0.5, MasterRule::lower_id}};
    testing::list_pairs(contacts, frames, 0.1);
    for (int step = 0; step < 3; ++step) {
      contacts.evaluate(frames, 1e-4);
      contacts.commit();
    }
    loads.emplace_back();
    for (std::size_t slot = 0; slot < grains.size(); ++slot) {
      EnergyLedger ledger;
      loads.back().push_back(contacts.load_on(slot, ledger));
    }
  }
  set_thread_count(before);
  for (std::size_t slot = 0; slot < grains.size(); ++slot) {
    for (std::size_t k = 1; k < loads.size(); ++k) {
      EXPECT_EQ(loads[k][slot].force, loads[0][slot].force);
      EXPECT_EQ(loads[k][slot].moment, loads[0][slot].moment);
    }
  }
}

}  // namespace
}  // namespace reckon
