// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>

#include "reckon/contact/coulomb.hpp"
#include "reckon/core/id.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon {

/// A node of the master that lies inside the slave: phi < 0. What a finder hands to a law.
struct Touch {
  NodeIndex node{0};
  double phi{0};        ///< signed distance in the slave, negative [m]
  Vec3 gradient_world;  ///< of the slave's interpolated distance, not normalised, out of the slave
  Vec3 lever_world;     ///< node minus the master's centre of mass [m]
  double area{0};       ///< the node's tributary area [m^2]
};

/// What all touching nodes of one pair share.
struct PairContext {
  double effective_mass{0};   ///< m_a m_b / (m_a + m_b); the grain's own mass on a wall [kg]
  double friction{0};         ///< Coulomb coefficient
  double total_area{0};       ///< of the touching nodes [m^2]
  double total_volume{0};     ///< sum of their areas times depths [m^3]
  double third_moment{0};     ///< sum of their areas times depths to the third power [m^5]
  double fourth_moment{0};    ///< and to the fourth [m^6]
  std::uint32_t touching{0};  ///< number of touching nodes
  double time_step{0};        ///< [s]
};

/// What a law answers for one node.
struct NodeForce {
  Vec3 force;                 ///< on the master, world frame [N]
  Vec3 shear_force;           ///< its frictional part: the new spring [N]
  double shear_stiffness{0};  ///< of that spring [N/m]
  double dashpot_push{0};     ///< the dashpot's part along the normal [N]
  double elastic{0};          ///< energy stored in the node's springs [J]
  double friction{0};         ///< energy lost in this step to sliding, and with a stiffness [J]
};

/// What the dashpot of a node takes in while the node goes from the step before to this one [J]:
/// the mean of its pushes at both times the way between them, which over a whole contact is its
/// push times the mean of the velocities before and after each step. `before` is last step's push,
/// zero where the node did not touch. A node about to leave does not come by again, so that the
/// second half of its last push is counted here.
[[nodiscard]] inline double dashpot_loss(double before, const NodeForce& now, const Touch& touch,
                                         double approach, double time_step) {
  const double way = approach * time_step;
  const double share = touch.phi + way < 0 ? 0.5 : 1.0;
  return -(0.5 * before + share * now.dashpot_push) * way;
}

/// A contact law: a small value type that turns one touching node into forces.
/// - `node_force`: the node's forces. `normal` is the unit normal out of the slave; `spring` is
/// that
///   of the last step, its force already turned to today's normal; `velocity` is that of the
///   master's node relative to the slave [m/s].
/// - `pair_scale`: a factor on everything that a pair of `context.touching` nodes does.
/// - `pair_stiffness` and `pair_damping`: how much more the pair pushes per depth and per speed of
///   approach, all touching nodes together [N/m], [N s/m].
template <class Law>
concept ContactLaw = requires(const Law law, const PairContext& context, const Touch& touch,
                              const Vec3& vector, const ShearSpring& spring) {
  { law.node_force(context, touch, vector, vector, spring) } -> std::same_as<NodeForce>;
  { law.pair_scale(context) } -> std::same_as<double>;
  { law.pair_stiffness(context) } -> std::same_as<double>;
  { law.pair_damping(context) } -> std::same_as<double>;
};

}  // namespace reckon
