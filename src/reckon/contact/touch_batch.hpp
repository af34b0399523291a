// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reckon/contact/node_lanes.hpp"
#include "reckon/contact/pair_kernel.hpp"
#include "reckon/contact/spring_store.hpp"
#include "reckon/contact/touch.hpp"

namespace reckon {

/// pair_force() for many masters and slaves at once. Nodes of all wait until they fill the lanes of
/// vector registers; each master's sums are then taken in node order as there.
///
///   clear()   add() add() add() ...   evaluate()   sum(0, ..) sum(1, ..) sum(2, ..) ...
class TouchBatch {
 public:
  void clear() {
    members_.clear();
    nodes_ = 0;
  }
  /// Arguments as pair_force() takes them. Returns the member's number.
  std::size_t add(PairContext context, const Vec3& master_center, const RigidMotion& master,
                  const RigidMotion& slave, std::span<const Touch> touches,
                  std::span<const NodeSpring> old_springs);
  /// Answers all members. `lanes` is any of law_lanes().
  void evaluate(const AnyContactLaw& law, double friction, double time_step, LawLanes lanes) {
    const std::size_t blocks = (nodes_ + TouchLanes::width - 1) / TouchLanes::width;
    lanes(law, friction, time_step, std::span{blocks_}.first(blocks));
  }
  /// What pair_force() returns; `old_springs` are those that add() got.
  template <ContactLaw Law>
  [[nodiscard]] DirectedForce sum(std::size_t member, const Law& law,
                                  std::span<const NodeSpring> old_springs, bool master_is_b,
                                  double weight, std::vector<NodeSpring>& new_springs,
                                  Mat3* first_moment = nullptr) const;

 private:
  struct Member {
    PairContext context;
    std::size_t first;  // node
  };

  std::vector<Member> members_;
  std::vector<TouchLanes> blocks_;
  std::size_t nodes_{0};
};

template <ContactLaw Law>
DirectedForce TouchBatch::sum(std::size_t member, const Law& law,
                              std::span<const NodeSpring> old_springs, bool master_is_b,
                              double weight, std::vector<NodeSpring>& new_springs,
                              Mat3* first_moment) const {
  const Member& m = members_[member];
  DirectedForce sum;
  if (first_moment != nullptr) *first_moment = {Vec3{}, Vec3{}, Vec3{}};
  auto old = old_springs.begin();
  const auto let_go = [&](const NodeSpring& gone) { sum.friction += gone.spring().stored(); };
  for (std::size_t n = m.first; n < m.first + m.context.touching; ++n) {
    const TouchLanes& block = blocks_[n / TouchLanes::width];
    const LaneTouches& touches = block.touches;
    const LaneResponses& responses = block.responses;
    const std::size_t lane = n % TouchLanes::width;
    if (!(responses.steepness[lane] > 0)) continue;
    const NodeIndex node = touches.node[lane];
    while (old != old_springs.end() && old->node < node) let_go(*old++);
    if (old != old_springs.end() && old->node == node) ++old;
    sum.force += responses.force[lane];
    sum.moment_master += responses.moment_master[lane];
    sum.moment_slave -= responses.moment_slave[lane];
    if (first_moment != nullptr) {
      *first_moment += outer(responses.force[lane], touches.lever_master[lane]);
    }
    sum.deepest = std::max(sum.deepest, -touches.phi[lane]);
    sum.elastic += responses.elastic[lane];
    sum.friction += responses.friction[lane];
    sum.dashpot += responses.dashpot[lane];
    new_springs.push_back(block.after.get(lane, node, master_is_b));
    ++sum.touching;
  }
  while (old != old_springs.end()) let_go(*old++);
  const double factor = weight * law.pair_scale(m.context);
  scale(sum, factor);
  sum.stiffness = weight * law.pair_stiffness(m.context);
  sum.damping = weight * law.pair_damping(m.context);
  if (first_moment != nullptr) *first_moment = factor * *first_moment;
  return sum;
}

}  // namespace reckon
