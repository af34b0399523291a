// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "reckon/contact/coulomb.hpp"
#include "reckon/contact/touch.hpp"

namespace reckon {

/// The paper's law (appendices A and B): every touching node is a spring of its own, so a pair's
/// stiffness grows with its number of touching nodes.
///
///   F_n = -k_n phi n - gamma (v . n) n        F_s: Coulomb spring with k_s, |F_s| <= mu |F_n|
///
/// Two options follow the authors' public code. The dashpot gamma = dashpot_factor sqrt(k_n m_eff)
/// may pull near separation. The cap scales a pair with n > node_cap touching nodes by node_cap/n.
struct LinearLaw {
  double normal_stiffness{0};  ///< k_n [N/m]
  double shear_stiffness{0};   ///< k_s [N/m]
  double dashpot_factor{0};    ///< see linear_dashpot_factor; 0: none
  std::uint32_t node_cap{0};   ///< 0: none

  [[nodiscard]] NodeForce node_force(const PairContext& context, const Touch& touch,
                                     const Vec3& normal, const Vec3& velocity,
                                     const ShearSpring& spring) const {
    const double approach = dot(normal, velocity);
    const double gamma = node_dashpot(context);
    const double push = -normal_stiffness * touch.phi - gamma * approach;
    CoulombSlider shear = slide(spring, velocity, normal, context.time_step, shear_stiffness,
                                context.friction * std::abs(push));
    return {.force = push * normal + shear.force,
            .shear_force = shear.force,
            .shear_stiffness = shear_stiffness,
            .dashpot_push = -gamma * approach,
            .elastic = 0.5 * normal_stiffness * touch.phi * touch.phi +
                       ShearSpring{shear.force, shear_stiffness}.stored(),
            .friction = shear.lost};
  }

  [[nodiscard]] double pair_scale(const PairContext& context) const {
    return node_cap > 0 && context.touching > node_cap
               ? static_cast<double>(node_cap) / static_cast<double>(context.touching)
               : 1.0;
  }

  [[nodiscard]] double pair_stiffness(const PairContext& context) const {
    return normal_stiffness * static_cast<double>(context.touching) * pair_scale(context);
  }

  [[nodiscard]] double pair_damping(const PairContext& context) const {
    return node_dashpot(context) * static_cast<double>(context.touching) * pair_scale(context);
  }

 private:
  [[nodiscard]] double node_dashpot(const PairContext& context) const {
    return dashpot_factor > 0
               ? dashpot_factor * std::sqrt(normal_stiffness * context.effective_mass)
               : 0;
  }
};
static_assert(ContactLaw<LinearLaw>);

/// The dashpot of a linear spring that returns the share `restitution` of the approach velocity:
/// gamma / sqrt(k m) = -2 ln e / sqrt(pi^2 + ln^2 e).
[[nodiscard]] double linear_dashpot_factor(double restitution);

}  // namespace reckon
