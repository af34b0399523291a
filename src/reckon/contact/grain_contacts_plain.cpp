// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The plain engine: every node of every listed pair, one after the other, at every step.
#include <algorithm>
#include <optional>
#include <variant>

#include "reckon/contact/grain_contacts.hpp"
#include "reckon/contact/grain_pair.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

/// A pair's springs by master: a's come first.
class SidedSprings {
 public:
  explicit SidedSprings(std::span<const NodeSpring> springs) : springs_{springs} {
    const auto is_of_b = [](const NodeSpring& spring) { return spring.master_is_b; };
    const auto first_of_b = std::find_if(springs.begin(), springs.end(), is_of_b);
    of_a_ = static_cast<std::size_t>(first_of_b - springs.begin());
  }
  [[nodiscard]] std::span<const NodeSpring> of(bool master_is_b) const {
    return master_is_b ? springs_.subspan(of_a_) : springs_.first(of_a_);
  }

 private:
  std::span<const NodeSpring> springs_;
  std::size_t of_a_;
};

}  // namespace

/// Tests every node and answers one after the other: the oracle.
template <ContactLaw Law>
void GrainContacts::evaluate_plainly(const Law& law, std::size_t p,
                                     std::span<const GrainFrame> frames, double time_step,
                                     Scratch& scratch) {
  std::optional<GrainFrame> image;
  const GrainFrame& a = frames[pairs_[p].slot_a];
  const GrainFrame& b = image_of_b(p, frames, image);
  const SidedSprings old{store_.read(springs_of_pair_[p])};
  const PairContext context = context_of(a, b, time_step);
  PairForce pair;
  new_springs_of_pair_[p] = store_.append([&](std::vector<NodeSpring>& arena) {
    for_each_master(settings_.master, a, b, [&](bool master_is_b, double weight) {
      const GrainFrame& master = master_is_b ? b : a;
      const GrainFrame& slave = master_is_b ? a : b;
      scratch.touches.clear();
      find_touches(master, slave, scratch.touches);
      add_directed(pair,
                   pair_force(law, context, master.position, motion_of(master), motion_of(slave),
                              scratch.touches, old.of(master_is_b), master_is_b, weight, arena),
                   master_is_b);
    });
  });
  forces_[p] = pair;
  finish(p, frames, scratch.counters);
}

void GrainContacts::evaluate_plainly(std::span<const GrainFrame> frames, double time_step,
                                     bool with_ghosts) {
  const std::size_t first = with_ghosts ? interior_ : 0;
  const std::size_t last = with_ghosts ? pairs_.size() : interior_;
  std::visit(
      [&](const auto& law) {
        parallel_for(last - first, 32, [&](std::size_t n) {
          evaluate_plainly(law, first + n, frames, time_step, scratch());
        });
      },
      settings_.law);
}

}  // namespace reckon
