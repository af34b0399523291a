// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/touch_batch.hpp"

namespace reckon {

std::size_t TouchBatch::add(PairContext context, const Vec3& master_center,
                            const RigidMotion& master, const RigidMotion& slave,
                            std::span<const Touch> touches,
                            std::span<const NodeSpring> old_springs) {
  count_touches(context, touches);
  members_.push_back({context, nodes_});
  const std::size_t blocks = (nodes_ + touches.size()) / TouchLanes::width + 1;
  if (blocks > blocks_.size()) blocks_.resize(2 * blocks);

  const Vec3 center_offset = master_center - slave.center;
  auto old = old_springs.begin();
  for (const Touch& touch : touches) {
    TouchLanes& block = blocks_[nodes_ / TouchLanes::width];
    const std::size_t lane = nodes_ % TouchLanes::width;
    const Vec3 lever_slave = touch.lever_world + center_offset;
    block.phi[lane] = touch.phi;
    block.area[lane] = touch.area;
    block.effective_mass[lane] = context.effective_mass;
    block.total_area[lane] = context.total_area;
    block.total_volume[lane] = context.total_volume;
    block.third_moment[lane] = context.third_moment;
    block.fourth_moment[lane] = context.fourth_moment;
    block.gradient.set(lane, touch.gradient_world);
    block.velocity.set(lane, velocity_at(master, touch.lever_world, slave, lever_slave));
    block.lever_master.set(lane, touch.lever_world);
    block.lever_slave.set(lane, lever_slave);
    while (old != old_springs.end() && old->node < touch.node) ++old;
    const bool is_old = old != old_springs.end() && old->node == touch.node;
    block.old_spring.set(lane, is_old ? old->shear_force : Vec3{});
    block.old_normal.set(lane, is_old ? old->normal : Vec3{});
    block.old_dashpot_push[lane] = is_old ? old->dashpot_push : 0;
    block.old_shear_stiffness[lane] = is_old ? old->shear_stiffness : 0;
    block.node[lane] = touch.node;
    block.touching[lane] = context.touching;
    ++nodes_;
  }
  return members_.size() - 1;
}

}  // namespace reckon
