// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/near_pairs.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(NearPairs, BlurredGrayStillTellsTheGap) {
  // Radius 20 voxels. The sum along the line is the gap averaged over the blur: g + s^2 / R, where
  // s^2 holds the blur, the voxel itself, the interpolation between voxels and the mean of lines.
  for (const double gap : {0.0, 0.5, 1.0}) {
    const auto balls = two_balls(gap / 20);
    ScannerSettings settings;
    settings.voxel = 0.05;
    settings.noise = 0;
    settings.void_gray = 100;
    settings.solid_gray = 300;
    const SimulatedScan scan = scan_assembly(balls.grains, balls.reader(), settings);
    const auto pairs = near_pairs(shape_views(balls.shapes), scan.grains, 0.09);
    ASSERT_EQ(pairs.size(), 1U);
    const double found = gray_gap(scan.gray, {200, 100, 300}, pairs[0]) / settings.voxel;
    const double spread = (0.8 * 0.8 + 2.0 / 12 + 0.5 * 0.5) / 20;
    EXPECT_NEAR(found, gap + spread, 0.05) << gap;
  }
}

}  // namespace
}  // namespace reckon
