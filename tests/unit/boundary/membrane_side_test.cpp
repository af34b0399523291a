// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/membrane_side.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace reckon {
namespace {

const CylinderPlace place{{0.1, -0.2, 0.3}, normalized(Vec3{1, 2, 2}), 0.5, 1.2};

Membrane placed() {
  MembraneSetup setup;
  setup.mould = WallId{0};
  setup.spacing = 0.03;
  setup.bond_stiffness = 1;
  setup.areal_mass = 1;
  Membrane membrane{setup};
  membrane.take_place(place, WallId{1}, WallId{2}, std::vector<WallPose>(3));
  return membrane;
}

/// Bulges, folds and bends away from its axis: the radius at an angle [turns] and a share of the
/// height, and how far the middle line is from the axis.
double radius_at(double turns, double share) {
  return 0.5 + 0.15 * std::sin(std::numbers::pi * share) +
         0.06 * std::cos(2 * std::numbers::pi * 7 * turns) * std::sin(2 * std::numbers::pi * share);
}
double bend_at(double share) { return 0.4 * share * share; }

struct Frame {
  Vec3 u;
  Vec3 v;
};
Frame frame() {
  const Vec3 u = normalized(cross(place.axis_unit, {0, 0, 1}));
  return {u, cross(place.axis_unit, u)};
}
Vec3 point_at(double radius, double turns, double share) {
  const auto [u, v] = frame();
  const double angle = 2 * std::numbers::pi * turns;
  return place.foot + share * place.height * place.axis_unit +
         (bend_at(share) + radius * std::cos(angle)) * u + radius * std::sin(angle) * v;
}

/// Against the closed form of the surface that its nodes lie on.
TEST(MembraneSide, MatchesTheSurfaceOfABentAndFoldedMembrane) {
  Membrane membrane = placed();
  MembraneState state = membrane.state();
  const auto [u, v] = frame();
  for (MembraneNode& node : state.nodes) {
    const Vec3 from_foot = node.position - place.foot;
    const double share = dot(from_foot, place.axis_unit) / place.height;
    const double turns = std::atan2(dot(from_foot, v), dot(from_foot, u)) / (2 * std::numbers::pi);
    node.position = point_at(radius_at(turns, share), turns, share);
  }
  membrane.adopt(state);
  const MembraneSide side{membrane};
  std::mt19937_64 random{11};
  std::uniform_real_distribution<double> unit{0, 1};
  for (int n = 0; n < 20000; ++n) {
    const double turns = unit(random);
    const double share = 0.01 + 0.98 * unit(random);
    const double surface = radius_at(turns, share);
    const double radius = 1.3 * unit(random);
    if (std::abs(radius - surface) < 0.02) continue;  // flat triangles on a curved surface
    EXPECT_EQ(side.is_outside(point_at(radius, turns, share)), radius > surface)
        << radius << " of " << surface << " at " << turns << ", " << share;
  }
}

/// A line that meets nodes or edges of the mesh must not put a point inside outside.
TEST(MembraneSide, PointsInLineWithNodesAreInside) {
  const Membrane membrane = placed();
  const MembraneSide side{membrane};
  const auto& places = membrane.mesh().places();
  for (std::uint32_t node = 0; node < places.size(); ++node) {
    if (membrane.mesh().is_end(node)) continue;
    const Vec3 from_foot = places[node] - place.foot;
    const Vec3 up = dot(from_foot, place.axis_unit) * place.axis_unit;
    for (const double share : {0.0, 0.3, 0.999}) {
      EXPECT_FALSE(side.is_outside(place.foot + up + share * (from_foot - up)));
    }
    EXPECT_TRUE(side.is_outside(place.foot + up + 1.001 * (from_foot - up)));
  }
}

TEST(MembraneSide, BeyondThePlanesIsNoMatterOfTheMembrane) {
  const Membrane membrane = placed();
  const MembraneSide side{membrane};
  EXPECT_FALSE(side.is_outside(place.foot - 0.1 * place.axis_unit));
  EXPECT_FALSE(side.is_outside(place.foot + 1.3 * place.axis_unit + Vec3{2, 0, 0}));
}

}  // namespace
}  // namespace reckon
