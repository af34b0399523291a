// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reckon/contact/coulomb.hpp"
#include "reckon/contact/touch.hpp"

namespace reckon {

/// Hertz and Mindlin's law for grains of any shape. Over the lens in which two paraboloids overlap
/// by d, the area of the master's surface at each depth is the same, 2 pi R* per depth, so that
///
///   S_p = sum of A depth^p = 2 pi R* d^(p+1) / (p+1)
///
/// over the touching nodes, whatever the curvature R*. Hertz's energy is a function of one of these
/// sums, the only one by which it is the square root of a sum over nodes:
///
///   E = 8/15 E* sqrt(R*) d^(5/2) = C sqrt(S_4),   C = 8/15 E* sqrt(5 / (2 pi))
///
/// It is taken as the law, for all shapes: each node is pushed with minus its derivative,
/// F = 2 C A depth^3 / sqrt(S_4) grad(phi). So frictionless contact conserves energy, and a node
/// that comes or goes, which has no depth, changes neither force nor stiffness at once. Spheres get
/// Hertz's 4/3 E* sqrt(R*) d^(3/2) as their nodes grow many. Overlap and radius of the contact are
///
///   d = 5/4 S_4 / S_3,   a = F / (4/3 E* d),   dF/dd = 2 E* a,   K_t = 8 G* a
///
/// Nodes share the dashpot and Mindlin's tangential stiffness K_t as they share the push; friction
/// is Coulomb's, node by node. The dashpot dashpot_factor sqrt(m_eff dF/dd) returns the set
/// restitution at any speed (Tsuji et al. 1992). No node pulls.
struct HertzLaw {
  double normal_modulus{0};  ///< E* [Pa]
  double shear_modulus{0};   ///< G* [Pa]
  double dashpot_factor{0};  ///< see hertz_dashpot_factor; 0: none

  [[nodiscard]] NodeForce node_force(const PairContext& context, const Touch& touch,
                                     const Vec3& normal, const Vec3& velocity,
                                     const ShearSpring& spring) const {
    const double share = context.third_moment > 0 ? depth_cubed(touch) / context.third_moment : 0;
    const double root = std::sqrt(context.fourth_moment);
    const double per_depth = root > 0 ? energy_factor * normal_modulus / root : 0;  // [N/m^5]
    const double elastic_push = 2 * per_depth * depth_cubed(touch) * norm(touch.gradient_world);
    const double approach = dot(normal, velocity);
    const double push = std::max(elastic_push - pair_damping(context) * share * approach, 0.0);
    const double stiffness = 8 * shear_modulus * contact_radius(context) * share;
    CoulombSlider shear =
        slide(spring, velocity, normal, context.time_step, stiffness, context.friction * push);
    return {.force = push * normal + shear.force,
            .shear_force = shear.force,
            .shear_stiffness = stiffness,
            .dashpot_push = push - elastic_push,
            .elastic = -per_depth * depth_cubed(touch) * touch.phi +
                       ShearSpring{shear.force, stiffness}.stored(),
            .friction = shear.lost};
  }

  [[nodiscard]] double pair_scale(const PairContext& /*context*/) const { return 1.0; }

  [[nodiscard]] double pair_stiffness(const PairContext& context) const {
    return 2 * normal_modulus * contact_radius(context);
  }

  [[nodiscard]] double pair_damping(const PairContext& context) const {
    return dashpot_factor * std::sqrt(context.effective_mass * pair_stiffness(context));
  }

 private:
  static constexpr double energy_factor = 8.0 / 15 * 0.8920620580763856;  // C / E*; sqrt(5/(2 pi))
  static constexpr double radius_factor = 1.2 * energy_factor;

  [[nodiscard]] static double depth_cubed(const Touch& touch) {  // times the area
    return -touch.area * (touch.phi * touch.phi * touch.phi);
  }
  /// What a becomes with F and d put in [m].
  [[nodiscard]] static double contact_radius(const PairContext& context) {
    const double ratio =
        context.fourth_moment > 0 ? context.third_moment / context.fourth_moment : 0;
    return radius_factor * context.third_moment * ratio /
           (context.fourth_moment > 0 ? std::sqrt(context.fourth_moment) : 1);
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
