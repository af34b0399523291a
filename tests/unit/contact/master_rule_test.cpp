// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// Whose nodes count (MasterRule::both): the answer is the same in whatever order grains are listed,
// and what one grain's nodes cannot resolve is seen by the other's.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "reckon/contact/grain_contacts.hpp"
#include "support/list_pairs.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

/// Two grains of different size and form; `swapped` lists the second one first.
class UnlikeGrains : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<GrainFrame> frames(bool swapped) const {
    GrainState large;
    large.shape = ShapeId{0};
    large.orientation = normalized(Quaternion{0.9, 0.1, -0.3, 0.2});
    large.angular_velocity_body = {1, 2, 3};
    GrainState small;
    small.shape = ShapeId{1};
    small.position = {1.2, 0.1, 0.05};
    small.orientation = normalized(Quaternion{0.2, 0.4, 0.1, -0.8});
    small.velocity = {-0.3, 0.2, 0.1};
    large.id = GrainId{swapped ? 1U : 0U};
    small.id = GrainId{swapped ? 0U : 1U};
    Grains grains;
    grains.push_back(swapped ? small : large);
    grains.push_back(swapped ? large : small);
    std::vector<GrainFrame> result;
    update_frames(grains, views_, 2000, result);
    return result;
  }
  [[nodiscard]] GrainContacts contacts(const AnyContactLaw& law) const {
    return GrainContacts{{law, 0.5, MasterRule::both, BondLaw{1e6, 1e6, 1e9, 1e9, 0.5}}};
  }

  Shape large_ = testing::bumpy_grain(1.0, 300);
  Shape small_ = testing::box({0.35, 0.3, 0.4}, 9, 0.02);
  std::vector<ShapeView> views_{ShapeView{large_}, ShapeView{small_}};
};

TEST_F(UnlikeGrains, AnswerDoesNotDependOnTheirOrder) {
  for (const AnyContactLaw& law :
       {AnyContactLaw{LinearLaw{1e4, 9e3, 0.3, 0}}, AnyContactLaw{AreaLaw{1e6, 9e5, 0.3, 0}},
        AnyContactLaw{hertz_law(1e7, 0.2, false, 0.3)}}) {
    std::array<PairForce, 2> found;
    for (const bool swapped : {false, true}) {
      GrainContacts both = contacts(law);
      const auto at = frames(swapped);
      testing::list_pairs(both, at, 0.5);
      both.evaluate(at, 1e-4);
      both.set_bonds(at);
      both.commit();
      both.evaluate(at, 1e-4);  // with springs and cement
      found[swapped ? 1 : 0] = both.forces()[0];
    }
    const PairForce& first = found[0];
    const PairForce& second = found[1];
    ASSERT_GT(first.touching, 10U);
    const double force = norm(first.force_on_a);
    EXPECT_EQ(first.touching, second.touching);
    EXPECT_EQ(first.deepest, second.deepest);
    EXPECT_LT(norm(first.force_on_a + second.force_on_a), 1e-12 * force);
    EXPECT_LT(norm(first.moment_a - second.moment_b), 1e-12 * force);
    EXPECT_LT(norm(first.moment_b - second.moment_a), 1e-12 * force);
    EXPECT_NEAR(first.elastic, second.elastic, 1e-12 * first.elastic);
    EXPECT_NEAR(first.friction, second.friction, 1e-12 * first.elastic);
    EXPECT_NEAR(first.stiffness, second.stiffness, 1e-6 * first.stiffness);
  }
}

/// How far a ball, small, moves into a large box of few nodes, and what answers.
PairForce ball_on_face(int nodes_per_edge, double overlap, double ball) {
  const Shape box = testing::box({1, 1, 1}, nodes_per_edge, 0.1);
  const Shape sphere = testing::sphere(ball, 800);
  const std::vector<ShapeView> views{ShapeView{box}, ShapeView{sphere}};
  Grains grains;
  GrainState state;
  grains.push_back(state);
  state.id = GrainId{1};
  state.shape = ShapeId{1};
  state.position = {0.01, -0.02, 1 + ball - overlap};
  grains.push_back(state);
  std::vector<GrainFrame> frames;
  update_frames(grains, views, 1, frames);
  GrainContacts contacts{{AreaLaw{1e6, 1e6, 0}, 0, MasterRule::both}};
  testing::list_pairs(contacts, frames, 0.1);
  contacts.evaluate(frames, 1e-5);
  return contacts.forces()[0];
}

TEST(MasterRuleBoth, GivesTheGrainThatResolvesTheOtherItsFullWeight) {
  const double ball = 0.05;
  const double overlap = 0.1 * ball;
  const double closed = std::numbers::pi * ball * 1e6 * overlap * overlap;
  const PairForce pair = ball_on_face(4, overlap, ball);
  EXPECT_NEAR(pair.force_on_a.z, -closed, 0.06 * closed);
  EXPECT_NEAR(pair.deepest, overlap, 0.1 * overlap);
}

TEST(MasterRuleBoth, CountsEachNodeOfGrainsAlikeByHalf) {
  const Shape shape = testing::bumpy_grain(1.0, 2000);
  const std::vector<ShapeView> views{ShapeView{shape}};
  Grains grains;
  GrainState state;
  grains.push_back(state);
  state.id = GrainId{1};
  state.position = {1.62, 0.1, 0.05};
  grains.push_back(state);
  std::vector<GrainFrame> frames;
  update_frames(grains, views, 1, frames);
  std::array<double, 2> energies{};
  for (const MasterRule rule : {MasterRule::lower_id, MasterRule::both}) {
    GrainContacts contacts{{AreaLaw{1e6, 1e6, 0}, 0, rule}};
    testing::list_pairs(contacts, frames, 0.1);
    contacts.evaluate(frames, 1e-5);
    energies[rule == MasterRule::both ? 1 : 0] = contacts.forces()[0].elastic;
  }
  EXPECT_NEAR(energies[1], energies[0], 0.03 * energies[0]);
}

}  // namespace
}  // namespace reckon
