// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/node_spacing.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "reckon/avatar/library_file.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

/// A scene of one grain of each shape, in this order.
LoadedScene scene_of(const std::vector<Shape>& shapes, MasterRule master) {
  LoadedScene scene;
  scene.config.contact.master = master;
  for (std::uint32_t n = 0; n < shapes.size(); ++n) {
    scene.shapes.push_back(summary_of(shapes[n]));
    scene.shapes.back().name = "shape_" + std::to_string(n);
    GrainState grain;
    grain.id = GrainId{n};
    grain.shape = ShapeId{n};
    scene.grains.push_back(grain);
  }
  return scene;
}

const Shape& large() {
  static const Shape shape = testing::bumpy_grain(1.0, 300, 16);
  return shape;
}
const Shape& small() {
  static const Shape shape = testing::bumpy_grain(0.1, 300, 16);
  return shape;
}

TEST(NodeSpacing, OfTheLowerIdMustServeEveryGrainAfterIt) {
  const auto told = coarse_nodes(scene_of({large(), small()}, MasterRule::lower_id));
  ASSERT_TRUE(told);
  EXPECT_NE(told->text.find("shape_0 lie 0.2"), std::string::npos) << told->text;
  EXPECT_NE(told->text.find("partner, shape shape_1"), std::string::npos) << told->text;
  EXPECT_NE(told->text.find("contact.master = \"both\""), std::string::npos) << told->text;
  EXPECT_FALSE(coarse_nodes(scene_of({small(), large()}, MasterRule::lower_id)));
}

TEST(NodeSpacing, GivesTheDepthThatNoNodeSees) {
  const Shape ball = testing::sphere(1.0, 300);
  const Shape grain = testing::sphere(0.1, 300);
  const auto told = coarse_nodes(scene_of({ball, grain}, MasterRule::lower_id));
  ASSERT_TRUE(told);
  const double spacing_squared = 4 * std::numbers::pi / 300;
  const double thickness = 0.2;
  EXPECT_NEAR(told->unseen, 0.4 * spacing_squared / (thickness * thickness), 0.01);
}

TEST(NodeSpacing, ServesInAnyOrderWhereTheSmallerOrBothAreMasters) {
  for (const MasterRule rule : {MasterRule::smaller, MasterRule::both}) {
    EXPECT_FALSE(coarse_nodes(scene_of({large(), small()}, rule)));
    EXPECT_FALSE(coarse_nodes(scene_of({small(), large()}, rule)));
  }
}

TEST(NodeSpacing, IsTooWideOnAShapeOfFewNodesOrAThinOne) {
  const Shape few = testing::bumpy_grain(1.0, 30, 16);
  const auto of_few = coarse_nodes(scene_of({few, few}, MasterRule::both));
  ASSERT_TRUE(of_few);
  EXPECT_EQ(of_few->text.find("contact.master"), std::string::npos) << of_few->text;
  const Shape plate = testing::box({1, 1, 0.05}, 7, 0.02);
  EXPECT_TRUE(coarse_nodes(scene_of({plate, plate}, MasterRule::both)));
  EXPECT_FALSE(coarse_nodes(scene_of({plate, small()}, MasterRule::both)));  // whose nodes see it
}

TEST(NodeSpacing, DoesNotMatterForSpheresWithoutNodes) {
  Shape sphere = testing::sphere(1.0, 30);
  EXPECT_TRUE(coarse_nodes(scene_of({sphere, sphere}, MasterRule::both)));
  sphere.sphere_radius = 1;
  LoadedScene scene = scene_of({sphere, sphere}, MasterRule::both);
  EXPECT_FALSE(coarse_nodes(scene));
  scene.config.contact.law = ContactLawKind::linear;
  EXPECT_TRUE(coarse_nodes(scene));
}

TEST(NodeSpacing, MustBeFinerAtTheEdgeOfALedge) {
  const Shape middling = testing::box({1, 1, 0.9}, 4, 0.1);  // h = 0.21 t
  LoadedScene scene = scene_of({middling}, MasterRule::both);
  EXPECT_FALSE(coarse_nodes(scene));
  WallConfig wall;
  wall.geometry = LedgeConfig{};
  scene.config.walls.push_back(wall);
  const auto told = coarse_nodes(scene);
  ASSERT_TRUE(told);
  EXPECT_NE(told->text.find("ledge"), std::string::npos);
}

}  // namespace
}  // namespace reckon
