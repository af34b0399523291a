// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/own_share.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reckon/scan/blur.hpp"

namespace reckon {
namespace {

constexpr double blur = 0.95;  // [voxels]
constexpr double radius = 10;
const Vec3 first{14.3, 14.6, 14.2};
const Vec3 direction{0.6, 0.48, 0.64};
const Vec3 label_direction = normalized(direction + Vec3{0.35, -0.35, 0});  // 26 degrees

/// The share of each voxel inside a ball, approximated from its distance.
GrayVolume ball(const Vec3& center) {
  GrayVolume share{VoxelDims{42, 40, 44}, 1};
  for_each_voxel(share.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const double depth = radius - norm(share.center_world(i, j, k) - center);
    share.values[share.index(i, j, k)] = static_cast<float>(std::clamp(0.5 + depth, 0.0, 1.0));
  });
  return share;
}

/// Two balls whose surfaces are `gap` apart, scanned together.
struct TwoBalls {
  GrayVolume alone;  // the first one's share, blurred
  GrayVolume both;
  GrayVolume ownership;

  explicit TwoBalls(double gap) {
    const GrayVolume a = ball(first);
    const GrayVolume b = ball(first + (2 * radius + gap) * direction);
    alone = a;
    blur_volume(alone, blur);
    both = a;
    ownership = GrayVolume{a, 0.5F};
    const Vec3 contact = first + (radius + 0.5 * gap) * direction;
    for_each_voxel(a.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const std::size_t v = a.index(i, j, k);
      both.values[v] = std::min(1.0F, a.values[v] + b.values[v]);
      if (both.values[v] < 0.5F) return;
      const double beyond = dot(a.center_world(i, j, k) - contact, label_direction);
      ownership.values[v] = beyond < 0 ? 1.0F : 0.0F;
    });
    blur_volume(both, blur);
  }
};

double farthest_apart(const GrayVolume& a, const GrayVolume& b) {
  double farthest = 0;
  for (std::size_t v = 0; v < a.values.size(); ++v) {
    farthest = std::max(farthest, std::abs(double{a.values[v]} - double{b.values[v]}));
  }
  return farthest;
}

TEST(OwnShare, ABallBesideAnotherLooksAsThoughScannedAlone) {
  for (const double gap : {0.0, 0.5, 1.0, 2.0}) {
    const TwoBalls scan{gap};
    const OwnShare own = own_share(scan.both, scan.ownership, blur);
    EXPECT_LT(farthest_apart(own.share, scan.alone), 0.08) << gap;
    EXPECT_GT(farthest_apart(scan.both, scan.alone), 0.9) << gap;
  }
}

/// The film between two balls is the plane half way, though the labels' border is a tilted
/// staircase.
TEST(OwnShare, TheBorderOfTwoPressedBallsIsThePlaneBetweenThem) {
  const double overlap = 1.5;
  const TwoBalls scan{-overlap};
  const OwnShare own = own_share(scan.both, scan.ownership, blur);
  const Vec3 contact = first + (radius - 0.5 * overlap) * direction;
  for_each_voxel(own.part.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const Vec3 from_contact = own.part.center_world(i, j, k) - contact;
    const double beyond = dot(from_contact, direction);
    if (norm(from_contact - beyond * direction) > 5) return;
    if (std::abs(beyond) < 0.2 || std::abs(beyond) > radius) return;
    const bool neighbours = own.part.values[own.part.index(i, j, k)] < 0.5F;
    EXPECT_EQ(neighbours, beyond > 0) << beyond;
  });
}

TEST(OwnShare, OfAGrainAloneIsAllThereIs) {
  const TwoBalls scan{2};
  const OwnShare own = own_share(scan.both, GrayVolume{scan.both, 1.0F}, blur);
  EXPECT_EQ(own.share.values, scan.both.values);
}

/// Labels have no blur: what is divided is divided between voxels.
TEST(OwnShare, SharpShareStaysSharp) {
  const TwoBalls scan{2};
  GrayVolume mask = scan.ownership;
  GrayVolume alone = mask;
  for (std::size_t v = 0; v < mask.values.size(); ++v) {
    mask.values[v] = scan.ownership.values[v] == 0.5F ? 0 : 1;
    alone.values[v] = scan.ownership.values[v] == 1.0F ? 1 : 0;
  }
  EXPECT_EQ(own_share(mask, scan.ownership, 0).share.values, alone.values);
}

}  // namespace
}  // namespace reckon
