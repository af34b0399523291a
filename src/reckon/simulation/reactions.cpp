// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/reactions.hpp"

#include <array>

#include "reckon/core/exact_sum.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/exact_totals.hpp"

namespace reckon {
namespace {

/// Of one pair, `d` being its branch.
CellReaction reaction_of(const PairForce& pair, const Vec3& d) {
  const Vec3& f = pair.force_on_a;
  const Vec3 squares = hadamard(d, d);
  return {{hadamard(f, d), f.x * d.y, f.x * d.z, f.y * d.z},
          double{pair.stiffness} * squares,
          double{pair.damping} * squares};
}

}  // namespace

std::vector<WallReaction> wall_reactions(const WallContacts& contacts, const Communicator& ranks) {
  const std::size_t walls = contacts.walls().size();
  std::vector<ExactSum> sums(3 * walls);  // forces, then stiffnesses, then dashpots
  for (std::size_t c = 0; c < contacts.candidates().size(); ++c) {
    const WallForce& contact = contacts.forces()[c];
    if (contact.touching == 0) continue;
    const std::size_t wall = contacts.candidates()[c].wall.get();
    const auto* plane = std::get_if<PlaneSurface>(&contacts.walls()[wall].surface);
    if (plane == nullptr) continue;  // no control moves it
    sums[wall].add(dot(contact.force, plane->normal_unit));
    sums[walls + wall].add(contact.stiffness);
    sums[2 * walls + wall].add(contact.damping);
  }
  add_up(ranks, sums);
  std::vector<WallReaction> reactions;
  for (std::size_t w = 0; w < walls; ++w) {
    reactions.push_back({sums[w].value(), sums[walls + w].value(), sums[2 * walls + w].value()});
  }
  return reactions;
}

CellReaction cell_reaction(const GrainContacts& contacts, std::span<const GrainFrame> frames,
                           std::size_t owned, const PeriodicCell& cell, const Communicator& ranks) {
  using Sums = std::array<ExactSum, 12>;
  std::vector<Sums> of_threads(static_cast<std::size_t>(thread_count()));
  const std::span<const PairForce> forces = contacts.forces();
  // The owner of its first grain counts a pair that two ranks share: first the sum of each grain,
  // in the order of partners, then the exact sum of all.
  parallel_for(owned, 64, [&](std::size_t slot) {
    CellReaction own;
    for (const auto& entry : contacts.pairs_of_grain().of(slot)) {
      const PairForce& pair = forces[entry.pair];
      if (entry.is_a && pair.holds()) {
        const Pair& ids = contacts.pairs()[entry.pair];
        own += reaction_of(pair,
                           cell.branch(frames[ids.slot_a].position, frames[ids.slot_b].position));
      }
    }
    const UpperMat3& v = own.virial;
    const std::array<double, 12> terms{v.diagonal.x,
                                       v.diagonal.y,
                                       v.diagonal.z,
                                       v.xy,
                                       v.xz,
                                       v.yz,
                                       own.stiffness.x,
                                       own.stiffness.y,
                                       own.stiffness.z,
                                       own.damping.x,
                                       own.damping.y,
                                       own.damping.z};
    Sums& sums = of_threads[static_cast<std::size_t>(thread_index())];
    for (std::size_t n = 0; n < terms.size(); ++n) {
      if (terms[n] != 0) sums[n].add(terms[n]);
    }
  });
  Sums& all = of_threads.front();
  for (std::size_t thread = 1; thread < of_threads.size(); ++thread) {
    for (std::size_t n = 0; n < all.size(); ++n) all[n].add(of_threads[thread][n]);
  }
  add_up(ranks, all);
  const auto value = [&all](std::size_t n) { return all[n].value(); };
  return {{{value(0), value(1), value(2)}, value(3), value(4), value(5)},
          {value(6), value(7), value(8)},
          {value(9), value(10), value(11)}};
}

}  // namespace reckon
