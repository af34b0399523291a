// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "reckon/contact/contact_settings.hpp"
#include "reckon/contact/pair_kernel.hpp"
#include "reckon/contact/simd_level.hpp"
#include "reckon/contact/spring_store.hpp"
#include "reckon/contact/touch.hpp"

namespace reckon {

/// Touching nodes of any pairs side by side, one array per quantity: what a law is asked, and what
/// it answers. Lanes that no node uses hold some older node or zeros.
struct alignas(64) TouchLanes {
  static constexpr std::size_t width = 8;
  using Numbers = std::array<double, width>;
  struct Vectors {
    Numbers x, y, z;

    [[nodiscard]] Vec3 operator[](std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
    void set(std::size_t lane, const Vec3& v) {
      x[lane] = v.x;
      y[lane] = v.y;
      z[lane] = v.z;
    }
  };

  // Asked: see Touch, PairContext and ContactLaw.
  Numbers phi, area, effective_mass, total_area, total_volume, third_moment, fourth_moment;
  Vectors gradient, velocity, lever_master, lever_slave;
  Vectors old_spring, old_normal;                 // zero where the node did not touch before
  Numbers old_dashpot_push, old_shear_stiffness;  // likewise

  // Answered.
  Numbers steepness;  // of the distance
  Vectors normal, force, shear_force, moment_master, moment_slave;
  Numbers dashpot_push, shear_stiffness, elastic, friction, dashpot;

  std::array<NodeIndex, width> node;
  std::array<std::uint32_t, width> touching;  // nodes of the pair
};

/// Answers all lanes of all blocks: the bits of pair_force() at every node.
using LawLanes = void (*)(const AnyContactLaw& law, double friction, double time_step,
                          std::span<TouchLanes> blocks);
[[nodiscard]] LawLanes law_lanes(SimdLevel level);

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
    const std::size_t lane = n % TouchLanes::width;
    if (!(block.steepness[lane] > 0)) continue;
    const NodeIndex node = block.node[lane];
    while (old != old_springs.end() && old->node < node) let_go(*old++);
    if (old != old_springs.end() && old->node == node) ++old;
    sum.force += block.force[lane];
    sum.moment_master += block.moment_master[lane];
    sum.moment_slave -= block.moment_slave[lane];
    if (first_moment != nullptr) {
      *first_moment += outer(block.force[lane], block.lever_master[lane]);
    }
    sum.deepest = std::max(sum.deepest, -block.phi[lane]);
    sum.elastic += block.elastic[lane];
    sum.friction += block.friction[lane];
    sum.dashpot += block.dashpot[lane];
    new_springs.push_back({node, master_is_b, block.shear_force[lane], block.normal[lane],
                           block.dashpot_push[lane], block.shear_stiffness[lane]});
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
