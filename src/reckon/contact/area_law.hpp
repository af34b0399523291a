// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "reckon/contact/coulomb.hpp"
#include "reckon/contact/touch.hpp"

namespace reckon {

/// Stiffness per area: a node pushes with its tributary area A, so the force of a pair converges
/// as nodes are added instead of growing with their number.
///
///   F_n = -k_n A phi grad(phi)      F_s: Coulomb spring with k_s A, |F_s| <= mu |F_n|
///
/// The gradient is that of the interpolant, not normalised: the normal force is then minus the
/// derivative of the energy k_n A phi^2 / 2, and a frictionless collision loses nothing.
///
/// The dashpot acts on the pair as a whole. Its coefficient dashpot_factor sqrt(m_eff k_n A_total)
/// follows the pair's tangent stiffness, which makes restitution independent of the speed of
/// impact (Tsuji et al. 1992 for Hertz's law); nodes share it as they share the elastic push. A
/// viscosity adds eta A (v . n) n per node. Neither lets a node pull. Both act at every node, so
/// they also damp rolling: nodes come in on one side of the contact and leave on the other.
struct AreaLaw {
  double normal_stiffness{0};  ///< k_n [N/m^3]
  double shear_stiffness{0};   ///< k_s [N/m^3]
  double dashpot_factor{0};    ///< see area_dashpot_factor; 0: none
  double viscosity{0};         ///< eta [N s/m^3]

  [[nodiscard]] NodeForce node_force(const PairContext& context, const Touch& touch,
                                     const Vec3& normal, const Vec3& velocity,
                                     const ShearSpring& spring) const {
    const double steepness = norm(touch.gradient_world);
    const double elastic_push = -normal_stiffness * touch.area * touch.phi * steepness;
    const double approach = dot(normal, velocity);
    const double share =
        context.total_volume > 0 ? -touch.area * touch.phi / context.total_volume : 0;
    const double gamma = pair_dashpot(context) * share + viscosity * touch.area;
    const double push = std::max(elastic_push - gamma * approach, 0.0);
    const double stiffness = shear_stiffness * touch.area;
    CoulombSlider shear =
        slide(spring, velocity, normal, context.time_step, stiffness, context.friction * push);
    return {.force = push * normal + shear.force,
            .shear_force = shear.force,
            .shear_stiffness = stiffness,
            .dashpot_push = push - elastic_push,
            .elastic = 0.5 * normal_stiffness * touch.area * touch.phi * touch.phi +
                       ShearSpring{shear.force, stiffness}.stored(),
            .friction = shear.lost};
  }

  [[nodiscard]] double pair_scale(const PairContext& /*context*/) const { return 1.0; }

  [[nodiscard]] double pair_stiffness(const PairContext& context) const {
    return normal_stiffness * context.total_area;
  }

  [[nodiscard]] double pair_damping(const PairContext& context) const {
    return pair_dashpot(context) + viscosity * context.total_area;
  }

 private:
  [[nodiscard]] double pair_dashpot(const PairContext& context) const {
    return dashpot_factor *
           std::sqrt(context.effective_mass * normal_stiffness * context.total_area);
  }
};
static_assert(ContactLaw<AreaLaw>);

/// The dashpot of the area law that returns the share `restitution` of the approach velocity of a
/// round contact, where the force grows with the square of the overlap:
///   x'' = -max(0, x^2 + alpha sqrt(2 x) x')   from x = 0, x' = 1 until x = 0 again.
/// Solved for alpha by bisection over a fixed-step Runge-Kutta integration. Flat contacts, whose
/// area does not grow, return slightly more.
[[nodiscard]] double area_dashpot_factor(double restitution);

}  // namespace reckon
