// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reckon/contact/spring_store.hpp"
#include "reckon/contact/touch.hpp"
#include "reckon/grains/grain_frame.hpp"

namespace reckon {

/// What one master does to one slave through all its touching nodes.
struct DirectedForce {
  Vec3 force;          ///< on the master, world frame [N]
  Vec3 moment_master;  ///< about the master's centre of mass, world frame [N m]
  Vec3 moment_slave;   ///< of the opposite force, about the slave's centre of mass [N m]
  std::uint32_t touching{0};
  double deepest{0};    ///< largest penetration [m]
  double elastic{0};    ///< [J]
  double friction{0};   ///< lost in this step [J]
  double dashpot{0};    ///< lost in this step [J]
  double stiffness{0};  ///< see ContactLaw [N/m]
  double damping{0};    ///< likewise [N s/m]
};

/// How the slave moves: the velocity of its material at a point.
struct RigidMotion {
  Vec3 center;                  ///< [m]
  Vec3 velocity;                ///< [m/s]
  Vec3 angular_velocity_world;  ///< [rad/s]
};

/// Of the master's material against the slave's where a node touches; levers from both centres
/// [m/s].
[[nodiscard]] inline Vec3 velocity_at(const RigidMotion& master, const Vec3& lever_master,
                                      const RigidMotion& slave, const Vec3& lever_slave) {
  return (master.velocity - slave.velocity) + cross(master.angular_velocity_world, lever_master) -
         cross(slave.angular_velocity_world, lever_slave);
}

[[nodiscard]] inline RigidMotion motion_of(const GrainFrame& grain) {
  return {grain.position, grain.velocity, grain.angular_velocity_world};
}

/// Counts one touching node into what all touching nodes of a pair share. They must come in node
/// order.
inline void count_touch(PairContext& context, double area, double phi) {
  const double volume = -area * phi;
  const double squared = phi * phi;
  ++context.touching;
  context.total_area += area;
  context.total_volume += volume;
  context.third_moment += volume * squared;
  context.fourth_moment -= volume * squared * phi;
}

/// Fills in what all touching nodes of a pair share.
inline void count_touches(PairContext& context, std::span<const Touch> touches) {
  context.touching = 0;
  context.total_area = 0;
  context.total_volume = 0;
  context.third_moment = 0;
  context.fourth_moment = 0;
  for (const Touch& touch : touches) count_touch(context, touch.area, touch.phi);
}

/// Scales forces, moments and energies.
inline void scale(DirectedForce& sum, double factor) {
  sum.force *= factor;
  sum.moment_master *= factor;
  sum.moment_slave *= factor;
  sum.elastic *= factor;
  sum.friction *= factor;
  sum.dashpot *= factor;
}

/// The plain finder (paper, Algorithm 2): every node of the master, in order, is taken to the
/// slave's frame, checked against its bounding sphere, then interpolated. Appends to `touches`.
void find_touches(const GrainFrame& master, const GrainFrame& slave, std::vector<Touch>& touches);

/// Turns the touching nodes of one master into forces, in node order, and appends their new
/// springs. `old_springs` are last step's springs of the same master and slave, in node order.
/// `weight` scales forces and energies (1, or 1/2 where both grains are masters in turn), not the
/// springs. Where `first_moment` is given, it becomes the sum of the nodes' forces times their
/// levers about the master's centre, f (x) l [N m].
template <ContactLaw Law>
DirectedForce pair_force(const Law& law, PairContext context, const Vec3& master_center,
                         const RigidMotion& master, const RigidMotion& slave,
                         std::span<const Touch> touches, std::span<const NodeSpring> old_springs,
                         bool master_is_b, double weight, std::vector<NodeSpring>& new_springs,
                         Mat3* first_moment = nullptr) {
  DirectedForce sum;
  if (first_moment != nullptr) *first_moment = {Vec3{}, Vec3{}, Vec3{}};
  count_touches(context, touches);
  const Vec3 center_offset = master_center - slave.center;
  auto old = old_springs.begin();
  const auto let_go = [&](const NodeSpring& gone) { sum.friction += gone.spring().stored(); };
  for (const Touch& touch : touches) {
    const double steepness = norm(touch.gradient_world);
    if (!(steepness > 0)) continue;  // a flat spot of the distance has no normal
    const Vec3 normal = touch.gradient_world / steepness;
    const Vec3 lever_slave = touch.lever_world + center_offset;
    const Vec3 velocity = velocity_at(master, touch.lever_world, slave, lever_slave);
    while (old != old_springs.end() && old->node < touch.node) let_go(*old++);
    ShearSpring spring;
    double dashpot_before = 0;
    if (old != old_springs.end() && old->node == touch.node) {
      spring = {rotate_between(old->shear_force, old->normal, normal), old->shear_stiffness};
      dashpot_before = old->dashpot_push;
      ++old;
    }
    const NodeForce node = law.node_force(context, touch, normal, velocity, spring);
    sum.force += node.force;
    sum.moment_master += cross(touch.lever_world, node.force);
    sum.moment_slave -= cross(lever_slave, node.force);
    if (first_moment != nullptr) *first_moment += outer(node.force, touch.lever_world);
    sum.deepest = std::max(sum.deepest, -touch.phi);
    sum.elastic += node.elastic;
    sum.friction += node.friction;
    sum.dashpot +=
        dashpot_loss(dashpot_before, node, touch, dot(normal, velocity), context.time_step);
    new_springs.push_back({touch.node, master_is_b, node.shear_force, normal, node.dashpot_push,
                           node.shear_stiffness});
    ++sum.touching;
  }
  while (old != old_springs.end()) let_go(*old++);

  const double factor = weight * law.pair_scale(context);
  scale(sum, factor);
  sum.stiffness = weight * law.pair_stiffness(context);
  sum.damping = weight * law.pair_damping(context);
  if (first_moment != nullptr) *first_moment = factor * *first_moment;
  return sum;
}

}  // namespace reckon
