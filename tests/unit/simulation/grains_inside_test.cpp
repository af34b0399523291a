// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/grains_inside.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "support/test_shapes.hpp"

namespace reckon {
namespace {

/// A scene of these shapes, read as a library's are.
struct Scene {
  ShapeLibrary shapes;
  std::vector<GrainState> grains;
  std::uint64_t reads{0};

  void add(std::uint32_t shape, const Vec3& position, const Quaternion& turn = {1, 0, 0, 0}) {
    GrainState grain;
    grain.id = GrainId{static_cast<std::uint32_t>(grains.size())};
    grain.shape = ShapeId{shape};
    grain.position = position;
    grain.orientation = turn;
    grains.push_back(grain);
  }
  [[nodiscard]] std::vector<GrainInside> found(const PeriodicCell* cell = nullptr,
                                               std::size_t most = 1000) {
    std::vector<ShapeOutline> outlines;
    for (const Shape& shape : shapes) outlines.push_back(outline_of(shape));
    return find_grains_inside(
        grains, outlines,
        [&](ShapeId shape) {
          ++reads;
          return shapes[shape.get()];
        },
        cell, most);
  }
};

using Ids = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
Ids ids_of(const std::vector<GrainInside>& found) {
  Ids ids;
  for (const GrainInside& pair : found) ids.emplace_back(pair.inner.get(), pair.outer.get());
  return ids;
}

Shape exact_sphere(double radius) {
  Shape shape = testing::sphere(radius, 100, 16);
  shape.sphere_radius = radius;
  return shape;
}

/// A ring in the plane of x and y: its centre of mass is in its hole.
Shape ring(double around, double thick) {
  Shape shape = testing::sphere(around + thick, 100, 16);
  shape.level_set = testing::sample_distance(
      [=](const Vec3& p) { return std::hypot(std::hypot(p.x, p.y) - around, p.z) - thick; },
      {around + thick, around + thick, thick}, thick / 6);
  return shape;
}

/// Exact spheres by their radii, others by their level sets, against the closed form.
TEST(GrainsInside, SpheresMatchTheClosedForm) {
  for (const bool exact : {true, false}) {
    Scene scene;
    const std::vector<double> radii{1, 0.6, 0.25};
    for (const double r : radii) {
      scene.shapes.push_back(exact ? exact_sphere(r) : testing::sphere(r, 100, 30));
    }
    std::mt19937_64 random{3};
    std::uniform_real_distribution<double> place{-4, 4};
    for (std::uint32_t n = 0; n < 150; ++n) {
      scene.add(n % 3, {place(random), place(random), place(random)});
    }
    Ids expected;
    for (std::uint32_t a = 0; a < 150; ++a) {
      for (std::uint32_t b = a + 1; b < 150; ++b) {
        const double apart = norm(scene.grains[a].position - scene.grains[b].position);
        if (!(apart < std::max(radii[a % 3], radii[b % 3]))) continue;
        // Named inside is the smaller one where its centre is, of equal ones the later.
        const bool a_is_smaller = radii[a % 3] < radii[b % 3];
        expected.emplace_back(a_is_smaller ? std::pair{a, b} : std::pair{b, a});
      }
    }
    std::sort(expected.begin(), expected.end());
    ASSERT_GT(expected.size(), 20U);
    EXPECT_EQ(ids_of(scene.found()), expected) << "exact " << exact;
    EXPECT_EQ(scene.reads == 0, exact);
  }
}

TEST(GrainsInside, WhollyInsideIsFoundInAnyOrder) {
  const Shape large = testing::box({2, 1, 0.5}, 10, 0.05);
  const Shape small = testing::box({0.1, 0.2, 0.1}, 4, 0.02);
  for (const bool large_first : {true, false}) {
    Scene scene;
    scene.shapes = {large, small};
    scene.add(large_first ? 0 : 1, large_first ? Vec3{} : Vec3{1.5, 0.5, 0.2});
    scene.add(large_first ? 1 : 0, large_first ? Vec3{1.5, 0.5, 0.2} : Vec3{});
    const auto found = scene.found();
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].inner.get(), large_first ? 1U : 0U);
    EXPECT_NEAR(found[0].depth, 0.3, 0.01);  // to the nearest face
  }
}

/// Faces overlap, even by a tenth of the thickness, but no centre is in the other grain.
TEST(GrainsInside, TouchingGrainsAreLeftAlone) {
  Scene scene;
  scene.shapes = {testing::box({2, 1, 0.5}, 10, 0.05), exact_sphere(0.5)};
  scene.add(0, {0, 0, 0});
  scene.add(0, {0.3, 0.2, 0.9});
  scene.add(0, {3.95, 0, 0});
  scene.add(1, {0, 0, -0.9});
  scene.add(1, {0, 0, -1.8});
  EXPECT_TRUE(scene.found().empty());
}

/// The centre of a ring is not in the ring: a grain there is outside, one on the ring is not.
TEST(GrainsInside, AHoleIsOutside) {
  Scene scene;
  scene.shapes = {ring(1, 0.3), exact_sphere(0.5)};
  scene.add(0, {0, 0, 0});
  scene.add(1, {0, 0, 0});
  EXPECT_TRUE(scene.found().empty());
  scene.grains[1].position = {1, 0, 0};
  EXPECT_EQ(ids_of(scene.found()), (Ids{{1, 0}}));
  // A ring all of which is in a large sphere.
  scene.shapes.push_back(exact_sphere(3));
  scene.grains[1].shape = ShapeId{2};
  EXPECT_EQ(ids_of(scene.found()), (Ids{{0, 1}}));
}

TEST(GrainsInside, ImagesInACellCount) {
  Scene scene;
  scene.shapes = {testing::sphere(1, 100, 30)};
  scene.add(0, {-4.9, 0, 0});
  scene.add(0, {4.9, 0.3, 0});     // 0.2 apart through the border
  scene.add(0, {25.1, 4, 4});      // in another image of the cell
  scene.add(0, {-14.7, 4, 14.1});  // 0.2 apart again
  const PeriodicCell cell{{}, {true, true, true}, {.diagonal = {10, 10, 10}}, {}};
  EXPECT_EQ(ids_of(scene.found(&cell)), (Ids{{1, 0}, {3, 2}}));
  EXPECT_TRUE(scene.found().empty());
}

TEST(GrainsInside, CopiesAreGroupedAndCountOnce) {
  Scene scene;
  scene.shapes = {testing::sphere(1, 100, 16), testing::box({1, 1, 1}, 4, 0.2)};
  for (int n = 0; n < 2000; ++n) scene.add(0, {1, 2, 3});
  scene.add(1, {30, 2, 3});
  scene.add(1, {1, 2, 3.5});
  scene.add(1, {30, 2, 3});
  scene.add(1, {30, 2, 3}, {0, 1, 0, 0});
  const std::vector<Copies> copies = find_copies(scene.grains);
  ASSERT_EQ(copies.size(), 2U);
  EXPECT_EQ(copies[0].size(), 2000U);
  EXPECT_EQ(copies[0][1], GrainId{1});
  EXPECT_EQ(copies[1], (Copies{GrainId{2000}, GrainId{2002}}));
  EXPECT_EQ(ids_of(scene.found()), (Ids{{0, 2001}, {2003, 2000}}));
}

/// Grains that are nearly in one place are a million pairs; the search ends with the first.
TEST(GrainsInside, EndsWithTheMostThatWasAskedFor) {
  Scene scene;
  scene.shapes = {testing::sphere(1, 100, 16)};
  for (int n = 0; n < 2000; ++n) scene.add(0, {1e-6 * n, 0, 0});
  EXPECT_EQ(scene.found(nullptr, 7).size(), 7U);
}

}  // namespace
}  // namespace reckon
