// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/wall_control.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace reckon {
namespace {

constexpr double dt = 1e-3;

/// Two planes across x that face each other, in a box of 2 x 3 x 5.
struct Box {
  std::vector<Wall> walls;
  std::vector<DrivenWall> driven{6};

  Box() {
    const Vec3 high{2, 3, 5};
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 inward;
      inward[axis] = 1;
      walls.push_back(plane({}, inward));
      walls.push_back(plane(high, -inward));
    }
  }
  static Wall plane(const Vec3& point, const Vec3& normal) {
    return {"plane", PlaneSurface{point, normal}, AreaLaw{1, 1, 0, 0}, 0, false, {}};
  }
  [[nodiscard]] Enclosure space() const {
    return *enclosure_of(walls, poses_at(walls, driven, 0, dt));
  }
  void move(const WallControl& control, std::span<const WallReaction> reactions) {
    advance({&control, 1}, walls, reactions, space(), dt, driven);
  }
};

WallControl along_x(WallTarget target, double value) {
  return {.name = "box.x",
          .walls = {WallId{0}, WallId{1}},
          .target = target,
          .value = value,
          .rate_limit = 1};
}

TEST(WallControl, StrainRateShrinksTheLengthExponentially) {
  Box box;
  const std::vector<WallReaction> nothing(6);
  for (int n = 0; n < 1000; ++n) box.move(along_x(WallTarget::strain_rate, 0.2), nothing);
  EXPECT_NEAR(box.space().size().x, 2 * std::exp(-0.2), 1e-4);
  EXPECT_EQ(box.space().size().y, 3);
  EXPECT_NEAR(box.space().low.x + box.space().high.x, 2, 1e-12);  // the middle stays
}

TEST(WallControl, SpeedIsThatOfEachPlaneInward) {
  Box box;
  const std::vector<WallReaction> nothing(6);
  for (int n = 0; n < 1000; ++n) box.move(along_x(WallTarget::speed, 0.1), nothing);
  EXPECT_NEAR(box.space().size().x, 2 - 2 * 0.1, 1e-12);
  EXPECT_EQ(box.driven[0].velocity, (Vec3{0.1, 0, 0}));
}

TEST(WallControl, ServoComesCloserAtItsLimitWhereNothingTouches) {
  Box box;
  const std::vector<WallReaction> nothing(6);
  box.move(along_x(WallTarget::stress, 100), nothing);
  EXPECT_EQ(box.driven[0].velocity.x, 1);  // half the length at a rate of one
  box.move(along_x(WallTarget::stress, 0), nothing);
  EXPECT_EQ(box.driven[0].velocity.x, 0);
}

/// Springs of any stiffness at both planes: the lack of force falls by 1 - gain in every step.
TEST(WallControl, ServoClosesTheGapByItsGainWhateverTheStiffness) {
  for (const double stiffness : {2e4, 1e9}) {
    Box box;
    const WallControl control = along_x(WallTarget::stress, 100);
    const auto reactions = [&] {
      std::vector<WallReaction> felt(6);
      felt[0] = {stiffness * box.driven[0].displacement.x, stiffness};
      felt[1] = {-stiffness * box.driven[1].displacement.x, stiffness};
      return felt;
    };
    double lacking = 100;
    // Until the gap is within the limit of the rate, planes come closer at most by that.
    while (lacking > 1e-6) {
      box.move(control, reactions());
      const double now = 100 - stress_on(control, reactions(), box.space());
      EXPECT_GE(now, -1e-9);
      if (stiffness > 1e6) {  // else planes move at their limit first
        EXPECT_NEAR(now / lacking, 1 - control.gain, 1e-6);
      }
      lacking = now;
    }
    EXPECT_NEAR(stress_on(control, reactions(), box.space()), 100, 1e-5);
  }
}

}  // namespace
}  // namespace reckon
