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
    LaneTouches& lanes = block.touches;
    const std::size_t lane = nodes_ % TouchLanes::width;
    const Vec3 lever_slave = touch.lever_world + center_offset;
    lanes.phi[lane] = touch.phi;
    lanes.area[lane] = touch.area;
    lanes.effective_mass[lane] = context.effective_mass;
    lanes.total_area[lane] = context.total_area;
    lanes.total_volume[lane] = context.total_volume;
    lanes.third_moment[lane] = context.third_moment;
    lanes.fourth_moment[lane] = context.fourth_moment;
    lanes.gradient.set(lane, touch.gradient_world);
    lanes.velocity.set(lane, velocity_at(master, touch.lever_world, slave, lever_slave));
    lanes.lever_master.set(lane, touch.lever_world);
    lanes.lever_slave.set(lane, lever_slave);
    while (old != old_springs.end() && old->node < touch.node) ++old;
    const bool is_old = old != old_springs.end() && old->node == touch.node;
    block.before.set(lane, is_old ? *old : NodeSpring{});
    lanes.node[lane] = touch.node;
    lanes.touching[lane] = context.touching;
    ++nodes_;
  }
  return members_.size() - 1;
}

}  // namespace reckon
