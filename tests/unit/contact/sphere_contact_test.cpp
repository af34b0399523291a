// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/sphere_contact.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "reckon/contact/grain_contacts.hpp"
#include "support/list_pairs.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

constexpr double radius_a = 1.0;
constexpr double radius_b = 0.6;
constexpr double reduced = radius_a * radius_b / (radius_a + radius_b);

/// Two spheres whose line of centres lies askew, `known` as spheres or as shapes of many nodes.
class TwoSpheres : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<GrainFrame> frames(double overlap, bool known) {
    for (Shape* shape : {&a_, &b_}) {
      const double radius = shape == &a_ ? radius_a : radius_b;
      shape->sphere_radius = known ? radius : 0;
    }
    views_ = {ShapeView{a_}, ShapeView{b_}};
    Grains grains;
    GrainState state;
    state.velocity = {0.01, -0.02, 0.005};
    state.angular_velocity_body = {0.3, -0.2, 0.1};
    grains.push_back(state);
    state.id = GrainId{1};
    state.shape = ShapeId{1};
    state.position = (radius_a + radius_b - overlap) * way_;
    state.orientation = normalized(Quaternion{0.2, 0.4, 0.1, -0.8});
    state.velocity = {};
    grains.push_back(state);
    std::vector<GrainFrame> result;
    update_frames(grains, views_, 2000, result);
    return result;
  }
  [[nodiscard]] PairForce force(const AnyContactLaw& law, double overlap, bool known,
                                ContactEngine engine = ContactEngine::near,
                                MasterRule master = MasterRule::lower_id) {
    GrainContacts contacts{{law, friction_, master}, engine};
    const auto at = frames(overlap, known);
    testing::list_pairs(contacts, at, 0.5);
    contacts.evaluate(at, 1e-4);
    return contacts.forces()[0];
  }

  double friction_{0.4};
  Vec3 way_ = normalized(Vec3{0.5, -0.3, 0.8});
  Shape a_ = testing::sphere(radius_a, 40000, 80);
  Shape b_ = testing::sphere(radius_b, 40000, 80);
  std::vector<ShapeView> views_;
};

TEST_F(TwoSpheres, AreaLawIsItsClosedForm) {
  friction_ = 0;
  const double stiffness = 1e7;
  for (const double overlap : {1e-6, 1e-3, 0.02}) {
    const PairForce pair = force(AreaLaw{stiffness, 1e-6 * stiffness, 0}, overlap, true);
    const double closed = std::numbers::pi * stiffness * reduced * overlap * overlap;
    EXPECT_NEAR(-dot(pair.force_on_a, way_), closed, 1e-9 * closed);
    EXPECT_NEAR(pair.elastic, closed * overlap / 3, 1e-9 * pair.elastic);
    EXPECT_NEAR(pair.deepest, overlap, 1e-9 * overlap);
  }
}

TEST_F(TwoSpheres, HertzLawIsItsClosedForm) {
  const HertzLaw law = hertz_law(1e8, 0.2, false, 0);
  const double overlap = 1e-3;
  const double modulus = 1e8 / (1 - 0.2 * 0.2) / 2;
  const double closed = 4.0 / 3 * modulus * std::sqrt(reduced) * std::pow(overlap, 1.5);
  EXPECT_NEAR(-dot(force(law, overlap, true).force_on_a, way_), closed, 1e-9 * closed);
}

TEST_F(TwoSpheres, NodesConvergeToIt) {
  const AreaLaw law{1e7, 8e6, 0.4};
  const double overlap = 0.05;
  const PairForce known = force(law, overlap, true);
  const PairForce nodes = force(law, overlap, false);
  ASSERT_GT(nodes.touching, 50U);
  EXPECT_EQ(known.touching, 3U);
  const double size = norm(known.force_on_a);
  EXPECT_LT(norm(known.force_on_a - nodes.force_on_a), 0.05 * size);
  EXPECT_LT(norm(known.moment_a - nodes.moment_a), 0.02 * size * radius_a);
  EXPECT_LT(norm(known.moment_b - nodes.moment_b), 0.02 * size * radius_b);
  EXPECT_NEAR(known.elastic, nodes.elastic, 0.08 * known.elastic);
}

TEST_F(TwoSpheres, BothEnginesGiveTheSameBitsAndApartNothing) {
  const AreaLaw law{1e7, 8e6, 0.4};
  for (const MasterRule master : {MasterRule::lower_id, MasterRule::smaller, MasterRule::both}) {
    for (const double overlap : {0.02, 1e-9, 0.0, -1e-9, -0.3}) {
      const PairForce near = force(law, overlap, true, ContactEngine::near, master);
      const PairForce plain = force(law, overlap, true, ContactEngine::plain, master);
      EXPECT_EQ(near.force_on_a, plain.force_on_a);
      EXPECT_EQ(near.moment_a, plain.moment_a);
      EXPECT_EQ(near.moment_b, plain.moment_b);
      EXPECT_EQ(near.elastic, plain.elastic);
      EXPECT_EQ(near.touching, plain.touching);
      if (overlap < 0) {
        EXPECT_EQ(near.touching, 0U);
      }
    }
  }
}

TEST_F(TwoSpheres, ActionAndReactionBalanceInForceAndMoment) {
  const PairForce pair = force(AreaLaw{1e7, 8e6, 0.4}, 0.02, true);
  const Vec3 apart = (radius_a + radius_b - 0.02) * way_;
  const Vec3 total = pair.moment_a + pair.moment_b - cross(apart, pair.force_on_a);
  EXPECT_LT(norm(total), 1e-12 * norm(pair.moment_a));
}

}  // namespace
}  // namespace reckon
