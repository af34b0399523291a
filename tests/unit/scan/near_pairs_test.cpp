// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/near_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reckon/scan/gray_gap.hpp"
#include "reckon/scan/scan_avatars.hpp"
#include "scan_fixture.hpp"

namespace reckon {
namespace {

/// Two balls of radius 1 side by side along x, a gap apart.
testing::TestAssembly two_balls(double gap) {
  testing::TestAssembly assembly;
  assembly.shapes = {testing::sphere(1, 4000, 40)};
  assembly.grains.resize(2);
  assembly.grains[1].id = GrainId{1};
  assembly.grains[1].position = {2 + gap, 0, 0};
  return assembly;
}

TEST(NearPairs, GapsOfBallsAreThoseOfTheirCentres) {
  for (const double gap : {-0.03, 0.02}) {
    const auto balls = two_balls(gap);
    const auto pairs = near_pairs(shape_views(balls.shapes), balls.grains, 0.05);
    ASSERT_EQ(pairs.size(), 1U);
    EXPECT_NEAR(pairs[0].gap, gap, 0.003);
    EXPECT_NEAR(pairs[0].normal_world.x, 1, 1e-3);
    EXPECT_NEAR(pairs[0].point_world.x, 1 + 0.5 * gap, 0.03);
  }
  const auto apart = two_balls(0.06);
  EXPECT_TRUE(near_pairs(shape_views(apart.shapes), apart.grains, 0.05).empty());
}

TEST(NearPairs, TheSameAsLookingAtAllPairs) {
  const auto assembly = testing::bumpy_assembly(3, 2, 2);
  const auto views = shape_views(assembly.shapes);
  const auto all = near_pairs(views, assembly.grains, 2e-5);
  std::size_t counted = 0;
  for (std::size_t a = 0; a < assembly.grains.size(); ++a) {
    for (std::size_t b = a + 1; b < assembly.grains.size(); ++b) {
      const std::vector<GrainState> two{assembly.grains[a], assembly.grains[b]};
      const auto pair = near_pairs(views, two, 2e-5);
      if (pair.empty()) continue;
      ASSERT_LT(counted, all.size());
      EXPECT_EQ(all[counted].a, a);
      EXPECT_EQ(all[counted].b, b);
      EXPECT_EQ(all[counted].gap, pair[0].gap);
      ++counted;
    }
  }
  EXPECT_EQ(counted, all.size());
  EXPECT_GT(counted, 5U);
}

TEST(NearPairs, SurfacesTouchWhereNoNodeIsThereToTell) {
  // A hundred nodes lie a third of a radius apart, so an overlap of 1 % slips between them.
  auto balls = two_balls(-0.01);
  balls.shapes = {testing::sphere(1, 100, 40)};
  const auto views = shape_views(balls.shapes);
  EXPECT_TRUE(near_pairs(views, balls.grains, 0).empty());
  const auto touching = near_surfaces(views, balls.grains, 0);
  ASSERT_EQ(touching.size(), 1U);
  EXPECT_NEAR(touching[0].gap, -0.01, 0.003);
  EXPECT_NEAR(touching[0].point_world.x, 0.995, 0.003);
  EXPECT_NEAR(touching[0].normal_world.x, 1, 1e-3);
  balls.grains[1].position.x = 2.03;
  EXPECT_TRUE(near_surfaces(views, balls.grains, 0.02).empty());
  ASSERT_EQ(near_surfaces(views, balls.grains, 0.04).size(), 1U);
  EXPECT_NEAR(near_surfaces(views, balls.grains, 0.04)[0].gap, 0.03, 0.003);
}

ScannerSettings clean_scanner(double voxel) {
  ScannerSettings settings;
  settings.voxel = voxel;
  settings.noise = 0;
  settings.void_gray = 100;
  settings.solid_gray = 300;
  return settings;
}

TEST(GrayGap, BlurOfAnEdgeIsMeasured) {
  for (const double blur : {0.6, 1.0}) {
    const auto balls = two_balls(0.5);
    ScannerSettings settings = clean_scanner(0.05);
    settings.blur = blur;
    const SimulatedScan scan = scan_assembly(balls.grains, balls.reader(), settings);
    EdgeProfile profile;
    EXPECT_EQ(profile.spread(), 1);
    for (std::size_t n = 0; n < balls.shapes[0].nodes.size(); n += 7) {
      const Vec3 body = balls.shapes[0].nodes.position(n);
      profile.add(scan.gray, {200, 100, 300}, scan.grains[0].position + body, normalized(body));
    }
    // The blur, the voxel itself, and the interpolation between voxels.
    EXPECT_NEAR(profile.spread(), std::sqrt(blur * blur + 1.0 / 12 + 1.0 / 6), 0.03) << blur;
  }
}

TEST(GrayGap, BlurredGrayStillTellsTheGapOfLargeAndSmallBalls) {
  for (const double radius : {8.0, 20.0}) {  // [voxels]
    for (const double gap : {0.0, 0.5, 1.0}) {
      // Askew to the voxels, whose partial volumes are counted on a lattice.
      auto balls = two_balls(0);
      balls.grains[1].position = (2 + gap / radius) * Vec3{0.48, 0.6, 0.64};
      const ScannerSettings settings = clean_scanner(1 / radius);
      const SimulatedScan scan = scan_assembly(balls.grains, balls.reader(), settings);
      const auto pairs = near_surfaces(shape_views(balls.shapes), scan.grains, 0.14);
      ASSERT_EQ(pairs.size(), 1U);
      const double spread = std::sqrt(0.8 * 0.8 + 1.0 / 12 + 1.0 / 6);
      const double found = gray_gap(scan.gray, {200, 100, 300}, pairs[0], spread) / settings.voxel;
      EXPECT_NEAR(found, gap, 0.06) << radius << ' ' << gap;
    }
  }
}

}  // namespace
}  // namespace reckon
