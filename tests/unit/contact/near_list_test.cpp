// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/near_list.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <map>

#include "reckon/contact/clearance.hpp"
#include "reckon/contact/displacement_bound.hpp"
#include "reckon/contact/pair_kernel.hpp"
#include "reckon/core/random.hpp"
#include "support/band_shape.hpp"
#include "support/random_motion.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

using testing::RandomMotion;

std::vector<Shape> zoo() {
  return {testing::sphere(1.0, 200, 16),       testing::bumpy_grain(1.0, 279, 18),
          testing::box({0.5, 0.8, 1}, 8, 0.1), testing::box({1.2, 1.2, 0.15}, 9, 0.06),
          testing::bumpy_grain(0.12, 90, 12),  testing::bumpy_grain(4.0, 1500, 40)};
}

void expect_same_touches(const std::vector<Touch>& a, const std::vector<Touch>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) {
    ASSERT_EQ(a[n].node, b[n].node);
    ASSERT_EQ(a[n].phi, b[n].phi);
    ASSERT_EQ(a[n].gradient_world, b[n].gradient_world);
    ASSERT_EQ(a[n].lever_world, b[n].lever_world);
    ASSERT_EQ(a[n].area, b[n].area);
  }
}

/// Keeps the nodes that touch, as the engine does.
struct Touching {
  NearList list;
  std::map<NodeIndex, NearNode> nodes;
  double next_check{check_always};

  /// Whether nothing had to be looked at.
  bool can_skip(double path_length) const { return nodes.empty() && path_length < next_check; }

  std::vector<Touch> touches(const GrainFrame& master, const GrainFrame& slave, double path_length,
                             PointFilter filter, ContactCounters& counters) {
    const double both_radii = master.shape->bounding_radius + slave.shape->bounding_radius;
    const double margin = rounding_margin(both_radii, path_length);
    std::vector<Touch> all;
    std::vector<NodeIndex> old;
    const NodeTest test{master, slave, margin};
    for (auto at = nodes.begin(); at != nodes.end();) {
      Touch touch;
      const bool meet = spheres_meet(master.position - slave.position, both_radii);
      const double clearance =
          meet ? test(NodeTarget{*slave.shape}, at->second, touch, counters) : 0;
      if (clearance == check_always) {
        all.push_back(touch);
        old.push_back(at->first);
        ++at;
      } else {
        list.take_back(at->second, path_length + clearance);
        next_check = std::min(next_check, path_length + clearance);
        at = nodes.erase(at);
      }
    }
    if (path_length < next_check) return all;
    std::vector<NearList::Found> found;
    next_check = list.find_touches(master, slave, path_length, filter, old, found, counters);
    for (const NearList::Found& f : found) {
      EXPECT_TRUE(nodes.emplace(f.node.node, f.node).second);
      all.push_back(f.touch);
    }
    std::sort(all.begin(), all.end(),
              [](const Touch& a, const Touch& b) { return a.node < b.node; });
    return all;
  }
};

/// Two grains wander about each other in strides from a hundred-thousandth of their size to half
/// of it, sometimes together. The list must find what the plain finder finds, and must never let
/// the pair sleep through a touch. In every other walk the shapes of the list are bands.
TEST(NearList, MissesNoTouchWhateverTheMotion) {
  std::deque<testing::BandShape> shapes;
  std::vector<ShapeView> whole;
  std::vector<ShapeView> bands;
  for (const Shape& shape : zoo()) {
    shapes.emplace_back(shape);
    whole.emplace_back(shapes.back().whole());
    bands.push_back(shapes.back().view());
  }
  std::uint64_t touched = 0;
  std::uint64_t slept = 0;
  ContactCounters counters;
  const std::vector<SimdLevel> levels = simd_levels_here();
  for (std::uint64_t walk = 0; walk < 300; ++walk) {
    const PointFilter filter = point_filter(levels[walk % levels.size()]);
    RandomStream random{walk, RandomPurpose::other, 7};
    const auto pick = [&] { return static_cast<std::size_t>(random.uniform(0, 6)); };
    const std::size_t form_a = pick();
    const std::size_t form_b = pick();
    const ShapeView& shape_a = whole[form_a];
    const ShapeView& shape_b = whole[form_b];
    const double size = std::min(shape_a.bounding_radius, shape_b.bounding_radius);
    const double contact = shape_a.bounding_radius + shape_b.bounding_radius;
    std::vector<GrainFrame> frames{{GrainId{0}, &shape_a}, {GrainId{1}, &shape_b}};
    RandomMotion a{random, frames[0], {}};
    RandomMotion b{random, frames[1], {0.9 * contact, 0, 0}};
    DisplacementBound displacements;
    Touching touching;
    for (int step = 0; step < 400; ++step) {
      const double stride = size * std::exp2(random.uniform(-17, -1));
      const Vec3 towards = frames[1].position - frames[0].position;
      // Held near contact: drawn together when apart, pushed apart when deep.
      const double pull = norm(towards) > 0.95 * contact  ? 1
                          : norm(towards) < 0.5 * contact ? -1
                                                          : 0;
      a.move(stride, pull * stride * normalized(towards));
      if (random.uniform() < 0.3) {
        b.follow(a.last_shift());
      } else {
        b.move(stride, {});
      }
      displacements.follow(frames);
      ASSERT_TRUE(displacements.trustworthy());
      const double path_length = displacements.path_lengths()[0] + displacements.path_lengths()[1];
      std::vector<Touch> expected;
      find_touches(frames[0], frames[1], expected);
      if (touching.can_skip(path_length)) {
        ASSERT_TRUE(expected.empty()) << "walk " << walk << " step " << step;
        ++slept;
        continue;
      }
      std::vector<GrainFrame> seen = frames;
      if (walk % 2 == 1) {
        seen[0].shape = &bands[form_a];
        seen[1].shape = &bands[form_b];
      }
      const std::vector<Touch> found =
          touching.touches(seen[0], seen[1], path_length, filter, counters);
      expect_same_touches(found, expected);
      if (HasFatalFailure()) FAIL() << "walk " << walk << " step " << step;
      touched += expected.empty() ? 0U : 1U;
    }
  }
  EXPECT_GT(touched, 10000U);
  EXPECT_GT(slept, 10000U);
  EXPECT_GT(counters.lists_checked, counters.lists_made);
}

/// A node that creeps up in steps far below the clearance is looked at a few times, not every time.
TEST(NearList, LooksSeldomAtWhatApproachesSlowly) {
  const Shape sphere = testing::sphere(1.0, 500, 30);
  const ShapeView view{sphere};
  std::vector<GrainFrame> frames{{GrainId{0}, &view}, {GrainId{1}, &view}};
  frames[1].position = {2.5, 0, 0};
  DisplacementBound displacements;
  Touching touching;
  ContactCounters counters;
  int looks = 0;
  while (touching.nodes.empty()) {
    frames[1].position.x -= 1e-4;
    displacements.follow(frames);
    const double path_length = displacements.path_lengths()[0] + displacements.path_lengths()[1];
    if (touching.can_skip(path_length)) continue;
    ++looks;
    touching.touches(frames[0], frames[1], path_length, point_filter(SimdLevel::automatic),
                     counters);
  }
  EXPECT_LT(frames[1].position.x, 2.01);
  EXPECT_LT(looks, 100);
}

TEST(Clearance, NeverExceedsTheDistanceToTheInside) {
  for (const Shape& shape : zoo()) {
    const ShapeView view{shape};
    const Clearance clearance{view};
    RandomStream random{2, RandomPurpose::other, 1};
    const double reach = 1.8 * view.bounding_radius;
    const auto any_point = [&] {
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(-reach, reach);
      return p;
    };
    std::vector<Vec3> inside;
    while (inside.size() < 2000) {
      const Vec3 p = any_point();
      const auto sample = view.level_set.sample(p);
      if (sample.inside_grid && sample.phi < 0) inside.push_back(p);
    }
    double tightest = 0;
    for (int n = 0; n < 2000; ++n) {
      const Vec3 p = any_point();
      double distance = std::numeric_limits<double>::infinity();
      for (const Vec3& q : inside) distance = std::min(distance, norm(p - q));
      ASSERT_LE(clearance.of_grid(p), distance);
      ASSERT_LE(clearance.of_sphere(p), distance);
      tightest = std::max(tightest, clearance.of_grid(p) / distance);
    }
    EXPECT_GT(tightest, 0.6);
  }
}

TEST(DisplacementBound, NoPointOutrunsTheMeter) {
  const Shape shape = testing::sphere(1.0, 50, 12);
  const ShapeView view{shape};
  RandomStream random{4, RandomPurpose::other, 0};
  for (int walk = 0; walk < 50; ++walk) {
    std::vector<GrainFrame> frames{{GrainId{5}, &view}};
    RandomMotion motion{random, frames[0], {random.uniform(-1e3, 1e3), 0, 0}};
    DisplacementBound displacements;
    displacements.follow(frames);
    const GrainFrame start = frames[0];
    for (int step = 0; step < 100; ++step) {
      motion.move(std::exp2(random.uniform(-30, 0)), {});
      displacements.follow(frames);
      for (std::size_t n = 0; n < view.nodes.size(); ++n) {
        const Vec3 before = start.position + start.rotation * view.nodes.position(n);
        const Vec3 now = frames[0].position + frames[0].rotation * view.nodes.position(n);
        ASSERT_LE(norm(now - before), displacements.path_lengths()[0]);
      }
    }
  }
}

TEST(DisplacementBound, FollowsGrainsByIdAndTrustsOnlyRotations) {
  const Shape shape = testing::sphere(1.0, 50, 12);
  const ShapeView view{shape};
  std::vector<GrainFrame> frames{{GrainId{5}, &view}, {GrainId{9}, &view, {4, 0, 0}}};
  DisplacementBound displacements;
  displacements.follow(frames);
  EXPECT_EQ(displacements.path_lengths()[0], 0);
  frames[1].position.x = 4.5;
  displacements.follow(frames);
  std::swap(frames[0], frames[1]);
  frames.push_back({GrainId{1}, &view});
  frames[0].position.x = 4.25;
  displacements.follow(frames);
  EXPECT_NEAR(displacements.path_lengths()[0], 0.75, 1e-9);
  EXPECT_GE(displacements.path_lengths()[0], 0.75);
  EXPECT_EQ(displacements.path_lengths()[1], 0);
  EXPECT_EQ(displacements.path_lengths()[2], 0);
  EXPECT_TRUE(displacements.trustworthy());
  frames[2].rotation = rotation_matrix({0.5, 0.5, 0.5, 0.501});
  displacements.follow(frames);
  EXPECT_FALSE(displacements.trustworthy());
  frames[2].rotation = rotation_matrix(normalized(Quaternion{0.5, 0.5, 0.5, 0.501}));
  displacements.follow(frames);
  EXPECT_TRUE(displacements.trustworthy());
}

}  // namespace
}  // namespace reckon
