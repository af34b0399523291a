// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/membrane_contacts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/test_shapes.hpp"

namespace reckon {
namespace {

constexpr double tube = 0.5;
constexpr double ball = 0.6;
constexpr double stiffness = 1e6;  // [N/m^3]
constexpr double dt = 1e-4;

/// A sphere a little too large for the membrane around it.
class BallInMembrane : public ::testing::Test {
 protected:
  BallInMembrane() {
    MembraneSetup setup;
    setup.spacing = 0.02;
    setup.bond_stiffness = 100;
    setup.contact = {stiffness, stiffness};
    setup.friction = 0.3;
    setup.areal_mass = 1;
    membrane_.emplace(setup);
    membrane_->take_place({{0, 0, -1}, {0, 0, 1}, tube, 2}, WallId{1}, WallId{2},
                          std::vector<WallPose>(3));
  }
  [[nodiscard]] std::vector<GrainFrame> at(const Vec3& place, const Vec3& velocity = {}) const {
    Grains grains;
    GrainState state;
    state.id = GrainId{4};
    state.position = place;
    state.velocity = velocity;
    state.orientation = normalized(Quaternion{0.9, 0.1, -0.3, 0.2});
    state.angular_velocity_body = {0.1, 0.4, -0.2};
    grains.push_back(state);
    std::vector<GrainFrame> frames;
    update_frames(grains, views_, 1000, frames);
    return frames;
  }

  Shape shape_ = testing::sphere(ball, 100, 80);
  std::vector<ShapeView> views_{ShapeView{shape_}};
  std::optional<Membrane> membrane_;
};

TEST_F(BallInMembrane, PushesAsTheIntegralOverTheBelt) {
  MembraneContacts contacts{ContactEngine::plain};
  contacts.evaluate(*membrane_, at({}), {}, dt);
  ASSERT_EQ(contacts.forces().size(), 1U);
  const MembraneForce& force = contacts.forces()[0];
  ASSERT_GT(force.touching, 500U);
  // Nodes are 0 to 0.1 deep in a belt around the ball.
  double energy = 0;
  double radial = 0;  // of what pushes nodes out
  const double belt = std::sqrt(ball * ball - tube * tube);
  constexpr int parts = 20000;
  for (int n = 0; n < parts; ++n) {
    const double z = belt * ((2 * n + 1.0) / parts - 1);
    const double r = std::hypot(tube, z);
    const double area = 2 * std::numbers::pi * tube * 2 * belt / parts;
    energy += 0.5 * stiffness * area * (ball - r) * (ball - r);
    radial += stiffness * area * (ball - r) * tube / r;
  }
  EXPECT_NEAR(force.elastic, energy, 0.01 * energy);
  double found = 0;
  for (const MembraneTouch& touch : contacts.touches()) {
    const Vec3& place = membrane_->nodes()[touch.spring.node].position;
    found += dot(touch.force, normalized(Vec3{place.x, place.y, 0}));
  }
  EXPECT_NEAR(found, radial, 0.02 * radial);  // shear has part in it
  EXPECT_NEAR(force.deepest, ball - tube, 2e-3);
}

TEST_F(BallInMembrane, TakesTheOppositeOfWhatItGives) {
  MembraneContacts contacts{ContactEngine::plain};
  const Vec3 place{0.03, -0.01, 0.1};
  contacts.evaluate(*membrane_, at(place, {0, 0, 2}), {}, dt);
  Vec3 force;
  Vec3 moment;
  for (const MembraneTouch& touch : contacts.touches()) {
    force -= touch.force;
    moment -= cross(membrane_->nodes()[touch.spring.node].position - place, touch.force);
  }
  const MembraneForce& on_grain = contacts.forces()[0];
  EXPECT_LT(norm(on_grain.force - force), 1e-12 * norm(force));
  EXPECT_LT(norm(on_grain.moment - moment), 1e-10 * norm(force));
  EXPECT_LT(on_grain.force.z, 0);  // friction holds it back
  Load load;
  EnergyLedger ledger;
  contacts.add_load(0, load, ledger);
  EXPECT_EQ(load.force, on_grain.force);
}

/// A walk through the membrane and back out of it, with lists kept and made anew on the way.
TEST_F(BallInMembrane, BothEnginesGiveTheSameBits) {
  MembraneContacts near{ContactEngine::near};
  MembraneContacts plain{ContactEngine::plain};
  DisplacementBound displacements;
  for (int n = 0; n < 300; ++n) {
    const double x = 1.4 * std::sin(0.03 * n);
    const auto frames = at({x, 0.2 * std::sin(0.05 * n), 0.3});
    displacements.follow(frames);
    near.evaluate(*membrane_, frames, displacements, dt);
    plain.evaluate(*membrane_, frames, {}, dt);
    ASSERT_EQ(near.forces().size(), plain.forces().size()) << n;
    for (std::size_t c = 0; c < near.forces().size(); ++c) {
      ASSERT_EQ(near.forces()[c].force, plain.forces()[c].force) << n;
      ASSERT_EQ(near.forces()[c].moment, plain.forces()[c].moment) << n;
      ASSERT_EQ(near.forces()[c].touching, plain.forces()[c].touching) << n;
    }
    membrane_->evaluate(plain.touches(), 0);
    membrane_->advance(0);  // keeps the springs, moves nothing
  }
  EXPECT_GT(near.lists_made(), 5U);
}

}  // namespace
}  // namespace reckon
