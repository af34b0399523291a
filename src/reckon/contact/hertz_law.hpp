// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reckon/contact/coulomb.hpp"
#include "reckon/contact/touch.hpp"

namespace reckon {

/// Hertz and Mindlin's law for grains of any shape. It needs the overlap d and the radius of the
/// contact a = sqrt(R* d); both follow from what touches, whatever the curvature R*. Two
/// paraboloids overlap by a lens of area A = 2 pi R* d and of volume V = pi R* d^2 on the master's
/// surface, so
///
///   d = 2 V / A,   a = sqrt(A / (2 pi)),   F = 4/3 E* a d,   dF/dd = 2 E* a,   K_t = 8 G* a
///
/// with A and V the sums over the touching nodes. Spheres get Hertz's 4/3 E* sqrt(R*) d^(3/2) and
/// Mindlin's tangential stiffness as their nodes grow many. Nodes share the push by their part of
/// the volume and the tangential stiffness by their part of the area; friction is Coulomb's, node
/// by node. The dashpot dashpot_factor sqrt(m_eff dF/dd) returns the set restitution at any speed
/// (Tsuji et al. 1992). No node pulls.
///
/// K_t grows and falls with the contact while its spring keeps its force, so a cycle of pressing
/// and shearing does not conserve energy exactly (Elata and Berryman 1996); the balance shows it.
struct HertzLaw {
  double normal_modulus{0};  ///< E* [Pa]
  double shear_modulus{0};   ///< G* [Pa]
  double dashpot_factor{0};  ///< see hertz_dashpot_factor; 0: none

  [[nodiscard]] NodeResponse respond(const PairContext& context, const Touch& touch,
                                     const Vec3& normal, const Vec3& velocity,
                                     const Vec3& spring) const {
    const double overlap =
        context.total_area > 0 ? 2 * context.total_volume / context.total_area : 0;
    const double radius = contact_radius(context);
    const double share =
        context.total_volume > 0 ? -touch.area * touch.phi / context.total_volume : 0;
    const double elastic_push = 4.0 / 3 * normal_modulus * radius * overlap * share;
    const double approach = dot(normal, velocity);
    const double push = std::max(elastic_push - pair_damping(context) * share * approach, 0.0);
    const double stiffness =
        context.total_area > 0 ? 8 * shear_modulus * radius * touch.area / context.total_area : 1;
    CoulombSlider shear =
        slide(spring, velocity, normal, context.time_step, stiffness, context.friction * push);
    const double in_spring = stiffness > 0 ? squared_norm(shear.force) / (2 * stiffness) : 0;
    return {.force = push * normal + shear.force,
            .shear_force = shear.force,
            .dashpot_push = push - elastic_push,
            .elastic = 0.4 * elastic_push * overlap + in_spring,
            .friction = shear.lost};
  }

  [[nodiscard]] double pair_scale(const PairContext& /*context*/) const { return 1.0; }

  [[nodiscard]] double pair_stiffness(const PairContext& context) const {
    return 2 * normal_modulus * contact_radius(context);
  }

  [[nodiscard]] double pair_damping(const PairContext& context) const {
    return dashpot_factor * std::sqrt(context.effective_mass * pair_stiffness(context));
  }

  /// A node that lets go has come up to the surface, where friction has left its spring no force.
  [[nodiscard]] double stored_shear_energy(const Vec3& /*spring*/, double /*area*/) const {
    return 0;
  }

 private:
  [[nodiscard]] static double contact_radius(const PairContext& context) {
    return std::sqrt(context.total_area / (2 * std::numbers::pi));
  }
};
static_assert(ContactLaw<HertzLaw>);

/// What two equal materials make of Young's modulus [Pa] and Poisson's ratio, or a material and a
/// rigid wall.
[[nodiscard]] inline HertzLaw hertz_law(double young_modulus, double poisson_ratio, bool rigid_wall,
                                        double dashpot_factor) {
  const double bodies = rigid_wall ? 1 : 2;
  const double shear = young_modulus / (2 * (1 + poisson_ratio));
  return {young_modulus / (bodies * (1 - poisson_ratio * poisson_ratio)),
          shear / (bodies * (2 - poisson_ratio)), dashpot_factor};
}

/// The dashpot that returns the share `restitution` of the approach velocity:
///   x'' = -max(0, x^(3/2) + alpha sqrt(3/2 x^(1/2)) x')   from x = 0, x' = 1 until x = 0 again,
/// solved for alpha as area_dashpot_factor is.
[[nodiscard]] double hertz_dashpot_factor(double restitution);

}  // namespace reckon
