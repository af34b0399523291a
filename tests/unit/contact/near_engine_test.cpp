// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// GrainContacts with the near engine against the plain one, over a few grains that wander about
// each other: forces, losses, springs and bonds of every pair have the same bits.
#include <gtest/gtest.h>

#include <deque>

#include "reckon/contact/grain_contacts.hpp"
#include "reckon/core/random.hpp"
#include "reckon/grains/periodic_cell.hpp"
#include "support/list_pairs.hpp"
#include "support/random_motion.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

using testing::RandomMotion;

Shape round_grain(double radius) {
  Shape shape = testing::sphere(radius, 150, 14);
  shape.sphere_radius = radius;
  return shape;
}

void expect_same(const GrainContacts& near, const GrainContacts& plain) {
  ASSERT_EQ(near.pairs().size(), plain.pairs().size());
  for (std::size_t p = 0; p < near.pairs().size(); ++p) {
    const PairForce& a = near.forces()[p];
    const PairForce& b = plain.forces()[p];
    ASSERT_EQ(near.pairs()[p].id_a, plain.pairs()[p].id_a);
    ASSERT_EQ(a.touching, b.touching);
    ASSERT_EQ(a.force_on_a, b.force_on_a);
    ASSERT_EQ(a.moment_a, b.moment_a);
    ASSERT_EQ(a.moment_b, b.moment_b);
    ASSERT_EQ(a.deepest, b.deepest);
    ASSERT_EQ(a.elastic, b.elastic);
    ASSERT_EQ(a.friction, b.friction);
    ASSERT_EQ(a.dashpot, b.dashpot);
    ASSERT_EQ(a.stiffness, b.stiffness);
    ASSERT_EQ(a.damping, b.damping);
    ASSERT_EQ(a.bonded, b.bonded);
    ASSERT_EQ(a.fracture, b.fracture);
  }
  ASSERT_EQ(near.springs(), plain.springs());
}

/// Grains held near one point, in strides from a hundred-thousandth of their size to half of it.
class Wanderers {
 public:
  Wanderers(std::uint64_t walk, std::span<const ShapeView> shapes)
      : random_{walk, RandomPurpose::other, 11} {
    for (std::uint32_t n = 0; n < 6; ++n) {
      const auto shape =
          static_cast<std::size_t>(random_.uniform(0, static_cast<double>(shapes.size())));
      frames.push_back({GrainId{n}, &shapes[shape]});
      frames.back().mass = random_.uniform(0.5, 2);
    }
    for (GrainFrame& frame : frames) motions_.emplace_back(random_, frame, vector(1.5));
  }

  void move(const Vec3& middle = {}) {
    const double size = std::exp2(random_.uniform(-17, -1));
    for (std::size_t n = 0; n < frames.size(); ++n) {
      const Vec3 away = frames[n].position - middle;
      const double pull = norm(away) > 1.6 ? 1 : norm(away) < 0.5 ? -1 : 0;
      motions_[n].move(size * random_.uniform(0, 1), -pull * size * normalized(away));
      frames[n].velocity = vector(1);
      frames[n].angular_velocity_world = vector(1);
    }
  }

  Vec3 vector(double size) {
    return {random_.uniform(-size, size), random_.uniform(-size, size),
            random_.uniform(-size, size)};
  }
  double uniform() { return random_.uniform(); }

  std::vector<GrainFrame> frames;

 private:
  RandomStream random_;
  std::vector<RandomMotion> motions_;
};

struct Walk {
  std::deque<Shape> shapes{testing::sphere(1.0, 200, 16), testing::bumpy_grain(1.0, 279, 18),
                           testing::box({0.5, 0.8, 1}, 8, 0.1), round_grain(0.8), round_grain(1.1)};
  std::vector<ShapeView> views{shapes.begin(), shapes.end()};

  static ContactSettings settings(std::uint64_t walk) {
    const std::array<AnyContactLaw, 3> laws{AreaLaw{1e6, 8e5, 0.3}, LinearLaw{1e4, 9e3, 0.3, 6},
                                            hertz_law(1e7, 0.2, false, 0.2)};
    const std::array masters{MasterRule::lower_id, MasterRule::smaller, MasterRule::both};
    ContactSettings settings{laws[walk % 3], 0.4, masters[walk / 3 % 3]};
    if (walk % 4 == 0) settings.bond = BondLaw{1e6, 1e6, 1e5, 1e5, 0.5};
    return settings;
  }
};

TEST(NearEngine, WandersAsThePlainOne) {
  const Walk scene;
  const std::vector<SimdLevel> levels = simd_levels_here();
  std::uint64_t touching = 0;
  for (std::uint64_t walk = 0; walk < 60; ++walk) {
    Wanderers grains{walk, scene.views};
    const ContactSettings settings = Walk::settings(walk);
    GrainContacts plain{settings, ContactEngine::plain};
    GrainContacts near{settings, ContactEngine::near, levels[walk % levels.size()]};
    const auto both = [&](auto&& call) {
      call(plain);
      call(near);
    };
    both([&](GrainContacts& c) { testing::list_pairs(c, grains.frames, 10); });
    for (int step = 0; step < 300; ++step) {
      grains.move();
      if (step == 100) grains.frames[0].rotation.row_x *= 1.01;  // is no rotation: lists end
      both([&](GrainContacts& c) { c.evaluate(grains.frames, 1e-4); });
      expect_same(near, plain);
      if (HasFatalFailure()) FAIL() << "walk " << walk << " step " << step;
      if (settings.bond && step % 20 == 0) {
        both([&](GrainContacts& c) { c.set_bonds(grains.frames); });
      }
      if (grains.uniform() < 0.9) both([](GrainContacts& c) { c.commit(); });
      if (step % 37 == 0) {
        both([&](GrainContacts& c) { testing::list_pairs(c, grains.frames, 10); });
      }
      if (step % 83 == 0) {  // a restart
        GrainContacts plain_again{settings, ContactEngine::plain};
        GrainContacts near_again{settings, ContactEngine::near, levels[walk % levels.size()]};
        plain_again.adopt(plain.springs());
        near_again.adopt(near.springs());
        ASSERT_EQ(near_again.springs(), plain.springs());
        plain = std::move(plain_again);
        near = std::move(near_again);
        both([&](GrainContacts& c) { testing::list_pairs(c, grains.frames, 10); });
        ASSERT_EQ(near.springs(), plain.springs());
      }
    }
    touching += near.counters().touching_nodes;
    EXPECT_EQ(near.counters().touching_nodes, plain.counters().touching_nodes);
  }
  EXPECT_GT(touching, 100000U);
}

/// A cell that shears on and on, so that its lattice is straightened now and then.
TEST(NearEngine, WandersInAShearedCellAsThePlainOne) {
  const Walk scene;
  for (std::uint64_t walk = 0; walk < 30; ++walk) {
    Wanderers grains{walk, scene.views};
    const ContactSettings settings = Walk::settings(walk);
    GrainContacts plain{settings, ContactEngine::plain};
    GrainContacts near{settings, ContactEngine::near};
    PeriodicCell cell{{}, {true, true, true}, UpperMat3{{6, 6, 6}, 0, 0, 0}, {}};
    const auto both = [&](auto&& call) {
      call(plain);
      call(near);
    };
    UpperMat3 moved = UpperMat3::identity();
    const auto set_cell = [&](GrainContacts& c) { c.set_cell(cell, {cell.center(), moved, 50}); };
    both(set_cell);
    both([&](GrainContacts& c) { testing::list_pairs(c, grains.frames, 100); });
    for (int step = 0; step < 300; ++step) {
      const UpperMat3 gradient = cell.advance({{}, 600, 200, -300}, 1e-3);
      const UpperMat3 stretch = UpperMat3::identity() + 1e-3 * gradient;
      moved = stretch;
      for (GrainFrame& frame : grains.frames) frame.position = stretch * frame.position;
      grains.move();
      both(set_cell);
      both([&](GrainContacts& c) { c.evaluate(grains.frames, 1e-4); });
      expect_same(near, plain);
      if (HasFatalFailure()) FAIL() << "walk " << walk << " step " << step;
      both([](GrainContacts& c) { c.commit(); });
    }
  }
}

TEST(NearEngine, AdoptsTheSameNewPairTwice) {
  for (const ContactEngine engine : {ContactEngine::near, ContactEngine::plain}) {
    GrainContacts contacts{{AreaLaw{1e6, 1e6, 0}, 0.5, MasterRule::both}, engine};
    const PairSprings pair{GrainId{4}, GrainId{9}, {{3, false, {1, 0, 0}, {0, 0, 1}, 2, 5}}};
    const std::vector twice{pair, pair};
    contacts.adopt(twice);
    EXPECT_EQ(contacts.springs(), std::vector{pair});
    contacts.rebuild({{GrainId{4}, GrainId{9}, 0, 1}}, 2, 2);
    EXPECT_EQ(contacts.springs(), std::vector{pair});
    contacts.adopt(twice);  // it has its springs
    contacts.rebuild({{GrainId{4}, GrainId{9}, 1, 0}}, 2, 2);
    EXPECT_EQ(contacts.springs(), std::vector{pair});
  }
}

}  // namespace
}  // namespace reckon
