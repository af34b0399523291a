// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>

#include "reckon/contact/touch.hpp"
#include "reckon/grains/grain_frame.hpp"
#include "reckon/math/portable.hpp"

namespace reckon {

/// Cement between two grains, as it was when it set: all that a bond remembers. It holds no force,
/// since the poses of its grains give that.
struct Bond {
  Vec3 arm_a;        ///< from a's centre of mass to the cement, body frame of a [m]
  Vec3 arm_b;        ///< likewise of b [m]
  Quaternion turn;   ///< b's body frame into a's
  Vec3 axis_a;       ///< unit, out of b into a, body frame of a
  double radius{0};  ///< of the disc of cement [m]

  friend bool operator==(const Bond&, const Bond&) = default;
};

/// Whether a bond holds.
enum class BondFate : std::uint8_t { holds, breaks_in_tension, breaks_in_shear };

/// What a bond does at one step.
struct BondForce {
  Vec3 force_on_a;    ///< b gets the opposite [N]
  Vec3 moment_a;      ///< about a's centre of mass [N m]
  Vec3 moment_b;      ///< about b's centre of mass [N m]
  double elastic{0};  ///< stored; what breaking releases [J]
  BondFate fate{BondFate::holds};
};

/// A disc of elastic cement that acts beside the contact law: the parallel bond of Potyondy and
/// Cundall (2004), written for finite poses instead of increments. With A = pi R^2, I = A R^2 / 4
/// and J = A R^2 / 2, in the frame of grain a, for the gap d between the two faces and the turn e
/// between them since the cement set, n along the axis:
///
///   F_n = k_n A d_n      F_s = k_s A d_s      M_bend = k_n I e_s      M_twist = k_s J e_n
///
/// It breaks for good where the greatest stress at its rim passes a strength,
///
///   sigma = F_n / A + |M_bend| R / I = k_n (d_n + R |e_s|) > tensile_strength    (d_n > 0: apart)
///   tau = |F_s| / A + |M_twist| R / J = k_s (|d_s| + R |e_n|) > shear_strength.
///
/// The turn is twice the vector part of its quaternion, 2 sin(angle / 2): the angle, as far as
/// cement can turn. Force and moments are then the exact derivative of the energy
/// (k_n A d_n^2 + k_s A d_s^2 + k_n I e_s^2 + k_s J e_n^2) / 2: a bond loses and makes none.
struct BondLaw {
  double normal_stiffness{0};  ///< k_n [N/m^3]
  double shear_stiffness{0};   ///< k_s [N/m^3]
  double tensile_strength{0};  ///< [Pa]
  double shear_strength{0};    ///< [Pa]
  double radius_share{0};      ///< R over the radius of the smaller grain's sphere of equal volume

  [[nodiscard]] BondForce bond_force(const Bond& bond, const GrainFrame& a,
                                     const GrainFrame& b) const {
    const Vec3 lever_b = b.rotation * bond.arm_b;
    const Vec3 lever_a = (b.position - a.position) + lever_b;  // of b's face, where all forces act
    const Vec3 gap = transposed_times(a.rotation, lever_a) - bond.arm_a;
    const Quaternion q = quaternion_from_matrix((transpose(a.rotation) * b.rotation) *
                                                transpose(rotation_matrix(bond.turn)));
    const Vec3 half_turn{q.x, q.y, q.z};
    const Vec3& n = bond.axis_a;
    const double apart = -dot(gap, n);  // n points from b to a
    const Vec3 slip = gap + apart * n;
    const double twist = 2 * dot(half_turn, n);
    const Vec3 bend = 2 * half_turn - twist * n;

    const double area = std::numbers::pi * bond.radius * bond.radius;
    const double second_moment = 0.25 * area * bond.radius * bond.radius;
    const Vec3 pull = area * (shear_stiffness * slip - normal_stiffness * apart * n);
    const Vec3 moment = second_moment * (normal_stiffness * bend + 2 * shear_stiffness * twist * n);
    const Vec3 torque = q.w * moment + cross(half_turn, moment);  // de/dt = w omega + omega x v

    BondForce force;
    force.force_on_a = a.rotation * pull;
    const Vec3 torque_world = a.rotation * torque;
    force.moment_a = cross(lever_a, force.force_on_a) + torque_world;
    force.moment_b = -cross(lever_b, force.force_on_a) - torque_world;
    force.elastic =
        0.5 * area * (normal_stiffness * apart * apart + shear_stiffness * squared_norm(slip)) +
        0.5 * second_moment *
            (normal_stiffness * squared_norm(bend) + 2 * shear_stiffness * twist * twist);
    if (!(normal_stiffness * (apart + bond.radius * norm(bend)) <= tensile_strength)) {
      force.fate = BondFate::breaks_in_tension;
    } else if (!(shear_stiffness * (norm(slip) + bond.radius * std::abs(twist)) <=
                 shear_strength)) {
      force.fate = BondFate::breaks_in_shear;
    }
    return force;
  }

  /// How much more a bond pushes or pulls per distance, at most [N/m].
  [[nodiscard]] double stiffness(const Bond& bond) const {
    const double area = std::numbers::pi * bond.radius * bond.radius;
    return area * std::max(normal_stiffness, shear_stiffness);
  }
  /// Of a bond at a grain as large as this sphere, the smaller of its two [m].
  [[nodiscard]] double bond_radius(double sphere_radius) const {
    return radius_share * sphere_radius;
  }
  /// How far the faces of an unbroken bond may be from each other [m].
  [[nodiscard]] double longest_gap() const {
    const double apart = tensile_strength / normal_stiffness;
    const double slip = shear_strength / shear_stiffness;
    return std::sqrt(apart * apart + slip * slip);
  }
};

/// The radius of the sphere with this volume [m].
[[nodiscard]] inline double sphere_radius_of(double volume) {
  return portable::cbrt(0.75 / std::numbers::pi * volume);
}

/// The nodes of one grain that touch the other, and what each counts.
struct WeightedTouches {
  std::span<const Touch> touches;
  double weight{1};
};

/// Sets cement between two grains where they touch: at the mean of the touching nodes, weighted
/// with their areas, along the mean of their normals. Nothing where they have no normal.
[[nodiscard]] inline std::optional<Bond> set_bond(const BondLaw& law, const GrainFrame& a,
                                                  const GrainFrame& b, const WeightedTouches& of_a,
                                                  const WeightedTouches& of_b) {
  Vec3 lever;  // from a's centre
  Vec3 normal;
  double area = 0;
  const auto add = [&](const WeightedTouches& side, const Vec3& center, double sign) {
    for (const Touch& touch : side.touches) {
      const double counts = side.weight * touch.area;
      lever += counts * (center + touch.lever_world);
      normal += (sign * counts) * normalized(touch.gradient_world);
      area += counts;
    }
  };
  add(of_a, {}, 1);
  add(of_b, b.position - a.position, -1);
  if (!(area > 0) || !(squared_norm(normal) > 0)) return std::nullopt;
  const Vec3 place = a.position + lever / area;
  const Vec3 axis = normalized(normal);
  const double smaller = std::min(a.shape->mass.volume, b.shape->mass.volume);
  return Bond{transposed_times(a.rotation, place - a.position),
              transposed_times(b.rotation, place - b.position),
              quaternion_from_matrix(transpose(a.rotation) * b.rotation),
              transposed_times(a.rotation, axis), law.bond_radius(sphere_radius_of(smaller))};
}

}  // namespace reckon
