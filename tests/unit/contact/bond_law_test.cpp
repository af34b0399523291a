// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/bond_law.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "reckon/contact/sphere_contact.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

Quaternion turn(const Vec3& axis, double angle) {
  const Vec3 half = std::sin(0.5 * angle) * normalized(axis);
  return {std::cos(0.5 * angle), half.x, half.y, half.z};
}

/// Two grains, askew in space, that touch in a point and are bonded there along x.
class TwoBondedGrains : public ::testing::Test {
 protected:
  struct Pose {
    Vec3 position;
    Quaternion orientation;
  };

  TwoBondedGrains() {
    const GrainFrame a = frame(GrainId{0}, a_);
    const GrainFrame b = frame(GrainId{1}, b_);
    const Touch touch{.gradient_world = {-1.1, 0, 0},  // out of b, not normalised
                      .lever_world = place_ - a_.position,
                      .area = 0.01};
    bond_ = *set_bond(law_, a, b, {{&touch, 1}}, {});
  }
  GrainFrame frame(GrainId id, const Pose& pose) const {
    return frame_of(id, view_, pose.position, pose.orientation, {}, {}, 2000);
  }
  BondForce force(const Pose& a, const Pose& b) const {
    return law_.bond_force(bond_, frame(GrainId{0}, a), frame(GrainId{1}, b));
  }
  /// Of b, moved and then turned about the place of the bond.
  BondForce force_with(const Vec3& move, const Vec3& axis, double angle) const {
    const Quaternion q = turn(axis, angle);
    const Vec3 from_bond = rotation_matrix(q) * (b_.position - place_);
    return force(a_, {place_ + from_bond + move, q * b_.orientation});
  }
  /// Moments of a pair without the arms of its force: those of the bond's own couple.
  Vec3 couple(const BondForce& f, const Vec3& move) const {
    return f.moment_a - cross(place_ + move - a_.position, f.force_on_a);
  }

  static constexpr double k_n = 4e9;
  static constexpr double k_s = 1.5e9;
  BondLaw law_{k_n, k_s, 2e5, 3e5, 0.5};
  Shape shape_ = testing::sphere(1.0, 100);
  ShapeView view_{shape_};
  Vec3 place_{0.31, -0.2, 0.5};
  Pose a_{place_ - Vec3{0.95, 0.1, 0.2}, normalized(Quaternion{0.3, -0.8, 0.2, 0.4})};
  Pose b_{place_ + Vec3{0.9, -0.15, 0.3}, normalized(Quaternion{0.9, 0.1, 0.5, -0.3})};
  Bond bond_;
  double area_ = std::numbers::pi * 0.25;
};

TEST_F(TwoBondedGrains, RestAsTheyWereSet) {
  EXPECT_NEAR(bond_.radius, 0.5, 1e-15);
  const BondForce still = force(a_, b_);
  EXPECT_EQ(still.fate, BondFate::holds);
  EXPECT_LT(norm(still.force_on_a), 1e-14 * k_n);
  EXPECT_LT(norm(still.moment_a), 1e-14 * k_n);
  EXPECT_LT(still.elastic, 1e-20 * k_n);
}

TEST_F(TwoBondedGrains, PullWithTheirArea) {
  const BondForce f = force_with({1e-6, 0, 0}, {1, 0, 0}, 0);
  EXPECT_NEAR(f.force_on_a.x, k_n * area_ * 1e-6, 1e-8 * f.force_on_a.x);
  EXPECT_LT(norm(couple(f, {1e-6, 0, 0})), 1e-8 * f.force_on_a.x);
  EXPECT_NEAR(f.elastic, 0.5 * k_n * area_ * 1e-12, 1e-8 * f.elastic);
}

TEST_F(TwoBondedGrains, ShearWithTheirArea) {
  const BondForce f = force_with({0, 3e-6, -4e-6}, {1, 0, 0}, 0);
  EXPECT_NEAR(f.force_on_a.y, k_s * area_ * 3e-6, 1e-8 * norm(f.force_on_a));
  EXPECT_NEAR(f.force_on_a.z, -k_s * area_ * 4e-6, 1e-8 * norm(f.force_on_a));
  EXPECT_NEAR(f.force_on_a.x, 0, 1e-8 * norm(f.force_on_a));
}

TEST_F(TwoBondedGrains, BendWithTheirSecondMoment) {
  const double inertia = std::numbers::pi / 4 * std::pow(0.5, 4);
  const BondForce f = force_with({}, {0, 1, 0}, 1e-5);
  const Vec3 moment = couple(f, {});
  EXPECT_NEAR(moment.y, k_n * inertia * 1e-5, 1e-8 * moment.y);
  EXPECT_LT(norm(moment - Vec3{0, moment.y, 0}), 1e-5 * moment.y);
  EXPECT_LT(norm(f.force_on_a), 1e-8 * moment.y);
}

TEST_F(TwoBondedGrains, TwistWithTheirPolarMoment) {
  const double polar = std::numbers::pi / 2 * std::pow(0.5, 4);
  const BondForce f = force_with({}, {1, 0, 0}, 1e-5);
  const Vec3 moment = couple(f, {});
  EXPECT_NEAR(moment.x, k_s * polar * 1e-5, 1e-8 * moment.x);
  EXPECT_LT(norm(moment - Vec3{moment.x, 0, 0}), 1e-5 * moment.x);
}

TEST_F(TwoBondedGrains, BreakInEachModeAtItsStrength) {
  const double radius = 0.5;
  const auto expect_breaks_at = [&](double limit, BondFate end,
                                    const std::function<BondForce(double)>& loaded) {
    EXPECT_EQ(loaded(0.9999 * limit).fate, BondFate::holds);
    EXPECT_EQ(loaded(1.0001 * limit).fate, end);
  };
  expect_breaks_at(2e5 / k_n, BondFate::breaks_in_tension, [&](double d) {
    return force_with({d, 0, 0}, {1, 0, 0}, 0);
  });
  expect_breaks_at(3e5 / k_s, BondFate::breaks_in_shear, [&](double d) {
    return force_with({0, 0.6 * d, 0.8 * d}, {1, 0, 0}, 0);
  });
  expect_breaks_at(2e5 / (k_n * radius), BondFate::breaks_in_tension, [&](double angle) {
    return force_with({}, {0, 0.6, 0.8}, angle);
  });
  expect_breaks_at(3e5 / (k_s * radius), BondFate::breaks_in_shear, [&](double angle) {
    return force_with({}, {1, 0, 0}, angle);
  });
  // Bending and pull add up; compression helps; compression alone never breaks it.
  expect_breaks_at(0.5 * 2e5 / k_n, BondFate::breaks_in_tension, [&](double d) {
    return force_with({d, 0, 0}, {0, 1, 0}, 0.5 * 2e5 / (k_n * radius));
  });
  EXPECT_EQ(force_with({-1e-4, 0, 0}, {0, 1, 0}, 2e5 / (k_n * radius)).fate, BondFate::holds);
  EXPECT_EQ(force_with({-0.1, 0, 0}, {1, 0, 0}, 0).fate, BondFate::holds);
}

TEST_F(TwoBondedGrains, ForceAndMomentsAreTheDerivativeOfTheEnergy) {
  law_.tensile_strength = law_.shear_strength = 1e30;
  const Pose a{a_.position + Vec3{0.1, -0.2, 0.05}, turn({1, 2, 3}, 0.8) * a_.orientation};
  const Pose b{b_.position + Vec3{0.2, 0.1, -0.1}, turn({-1, 1, 0.3}, 0.5) * b_.orientation};
  const BondForce f = force(a, b);
  const double step = 1e-5;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 along;
    along[axis] = 1;
    const auto slope = [&](const std::function<double(double)>& energy) {
      return (energy(step) - energy(-step)) / (2 * step);
    };
    const auto moved = [&](Pose pose, double h) {
      pose.position += h * along;
      return pose;
    };
    const auto turned = [&](Pose pose, double h) {
      pose.orientation = turn(along, h) * pose.orientation;
      return pose;
    };
    const double force_scale = norm(f.force_on_a);
    EXPECT_NEAR(f.force_on_a[axis], -slope([&](double h) { return force(moved(a, h), b).elastic; }),
                1e-7 * force_scale);
    EXPECT_NEAR(-f.force_on_a[axis],
                -slope([&](double h) { return force(a, moved(b, h)).elastic; }),
                1e-7 * force_scale);
    EXPECT_NEAR(f.moment_a[axis], -slope([&](double h) { return force(turned(a, h), b).elastic; }),
                1e-7 * force_scale);
    EXPECT_NEAR(f.moment_b[axis], -slope([&](double h) { return force(a, turned(b, h)).elastic; }),
                1e-7 * force_scale);
  }
  // Nothing turns the pair as a whole.
  const Vec3 all = f.moment_a + f.moment_b + cross(a.position - b.position, f.force_on_a);
  EXPECT_LT(norm(all), 1e-12 * norm(f.moment_a));
}

TEST_F(TwoBondedGrains, TurnWithThePair) {
  const Quaternion q = turn({0.3, -1, 0.4}, 2.1);
  const Mat3 r = rotation_matrix(q);
  const Pose b{b_.position + Vec3{1e-5, -2e-5, 3e-5}, turn({1, 1, 0}, 1e-5) * b_.orientation};
  const BondForce here = force(a_, b);
  const BondForce there =
      force({r * a_.position, q * a_.orientation}, {r * b.position, q * b.orientation});
  EXPECT_LT(norm(there.force_on_a - r * here.force_on_a), 1e-9 * norm(here.force_on_a));
  EXPECT_LT(norm(there.moment_a - r * here.moment_a), 1e-9 * norm(here.moment_a));
  EXPECT_LT(norm(there.moment_b - r * here.moment_b), 1e-9 * norm(here.moment_b));
}

TEST_F(TwoBondedGrains, AreSetWhereTheirNodesTouchWhoeverIsTheMaster) {
  shape_.sphere_radius = 1;
  view_ = ShapeView{shape_};
  const GrainFrame a = frame(GrainId{0}, {{}, a_.orientation});
  const GrainFrame b = frame(GrainId{1}, {{0, 1.9, 0}, b_.orientation});
  std::vector<Touch> of_a;
  std::vector<Touch> of_b;
  touch_spheres(a, b, of_a);
  touch_spheres(b, a, of_b);
  for (const Bond& bond : {*set_bond(law_, a, b, {of_a}, {}), *set_bond(law_, a, b, {}, {of_b}),
                           *set_bond(law_, a, b, {of_a, 0.3}, {of_b, 0.7})}) {
    EXPECT_LT(norm(a.rotation * bond.arm_a - Vec3{0, 0.95, 0}), 1e-15);
    EXPECT_LT(norm(b.rotation * bond.arm_b - Vec3{0, -0.95, 0}), 1e-15);
    EXPECT_LT(norm(a.rotation * bond.axis_a - Vec3{0, -1, 0}), 1e-15);
  }
  EXPECT_FALSE(set_bond(law_, a, b, {}, {}));
}

}  // namespace
}  // namespace reckon
