// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/grain_contacts.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include "reckon/contact/grain_pair.hpp"
#include "reckon/contact/near_skin.hpp"
#include "reckon/contact/pair_kernel.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

std::pair<GrainId, GrainId> ids_of(const Pair& pair) { return {pair.id_a, pair.id_b}; }

}  // namespace

void GrainContacts::rebuild(std::vector<Pair> pairs, std::size_t slot_count, std::size_t owned) {
  // By ids first, as the old ones can be gone through, then by slots.
  std::vector<std::uint32_t> order(pairs.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto has_ghost = [&](const Pair& pair) {
    return pair.slot_a >= owned || pair.slot_b >= owned;
  };
  const auto key = [&](std::uint32_t p) {
    const auto [low, high] = std::minmax(pairs[p].slot_a, pairs[p].slot_b);
    return std::tuple{has_ghost(pairs[p]), low, high};
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t p, std::uint32_t q) { return key(p) < key(q); });
  std::vector<std::uint32_t> by_ids(pairs.size());
  for (std::uint32_t place = 0; place < order.size(); ++place) by_ids[order[place]] = place;

  std::vector<Pair> listed(pairs.size());
  std::vector<std::uint32_t> old_pairs(pairs.size(), PairLanes::new_pair);
  auto old = by_ids_.begin();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    listed[by_ids[p]] = pairs[p];
    while (old != by_ids_.end() && ids_of(pairs_[*old]) < ids_of(pairs[p])) ++old;
    if (old != by_ids_.end() && ids_of(pairs_[*old]) == ids_of(pairs[p])) {
      old_pairs[by_ids[p]] = *old;
    }
  }
  pairs_ = std::move(listed);
  by_ids_ = std::move(by_ids);
  interior_ = static_cast<std::size_t>(std::count_if(
      pairs_.begin(), pairs_.end(), [&](const Pair& pair) { return !has_ghost(pair); }));

  // What is remembered of pairs that were listed.
  std::vector<double> next_check(pairs_.size(), check_always);
  std::vector<NearPair> near(pairs_.size());
  std::vector<Vec3> images(cell_ ? pairs_.size() : 0);
  std::vector<SpringRange> springs(pairs_.size());
  const auto old_bonds = std::exchange(bonds_, {});
  const auto old_bond_of_pair = std::exchange(bond_of_pair_, {});
  fates_.clear();
  pair_of_bond_.clear();
  bond_of_pair_.assign(pairs_.size(), no_bond);
  if (engine_ == ContactEngine::near) lanes_.rebuild(pairs_, interior_, old_pairs);
  for (const std::uint32_t p : by_ids_) {
    const std::uint32_t place = old_pairs[p];
    if (place == PairLanes::new_pair) continue;
    next_check[p] = next_check_[place];
    near[p] = std::move(near_[place]);
    if (place < images_.size() && cell_) images[p] = images_[place];
    if (place < springs_of_pair_.size()) springs[p] = springs_of_pair_[place];
    if (const auto bond = old_bond_of_pair[place]; bond != no_bond) keep_bond(p, old_bonds[bond]);
  }
  next_check_ = std::move(next_check);
  near_ = std::move(near);
  images_ = std::move(images);
  springs_of_pair_ = std::move(springs);
  new_springs_of_pair_.assign(pairs_.size(), {});
  // A pair that does not act writes neither.
  forces_.assign(pairs_.size(), {});
  acts_.assign(pairs_.size(), 0);
  pairs_of_grain_ = index_pairs(pairs_, by_ids_, slot_count);

  for (const std::uint32_t p : by_ids_) {
    if (adopted_.empty()) break;
    const auto found = adopted_.find(ids_of(pairs_[p]));
    if (found == adopted_.end()) continue;
    const PairSprings& adopted = found->second;
    if (adopted.bond && bond_of_pair_[p] == no_bond) keep_bond(p, *adopted.bond);
    // Both ranks of a pair hold the same springs.
    if (springs_of(p).empty()) set_springs(p, adopted.springs);
  }
  adopted_.clear();
}

std::vector<NodeSpring> GrainContacts::springs_of(std::size_t p) const {
  if (engine_ == ContactEngine::near) return lanes_.springs(p);
  const auto springs = store_.read(springs_of_pair_[p]);
  return {springs.begin(), springs.end()};
}

/// Of a pair that has none.
void GrainContacts::set_springs(std::size_t p, std::span<const NodeSpring> springs) {
  if (engine_ == ContactEngine::near) {
    lanes_.adopt(pairs_[p], p, springs);
    near_[p] = {};
    next_check_[p] = check_always;
  } else {
    springs_of_pair_[p] = store_.adopt(springs);
  }
}

void GrainContacts::set_cell(const PeriodicCell& cell, const CellMotion& motion) {
  cell_ = cell;
  cell_motion_ = motion;
  images_.resize(pairs_.size());
  // Half a width. Beyond `farthest` the path lengths do not include what the motion of the cell
  // does, so no more than that can be assumed.
  image_distance_ = std::min(0.5 * cell.least_width(), motion.farthest);
}

/// b as a meets it: without a cell b itself, else its image nearest to a. Near lists that were
/// about another image are forgotten.
const GrainFrame& GrainContacts::image_of_b(std::size_t p, std::span<const GrainFrame> frames,
                                            std::optional<GrainFrame>& image) {
  const GrainFrame& b = frames[pairs_[p].slot_b];
  if (!cell_) return b;
  const Vec3 edges = cell_->nearest_image(frames[pairs_[p].slot_a].position - b.position);
  if (edges != images_[p]) {
    images_[p] = edges;
    near_[p] = {};
    next_check_[p] = check_always;
  }
  if (edges == Vec3{}) return b;
  image = b;
  image->position += cell_->shift_of(edges);
  image->velocity += cell_->velocity_of(edges);
  return *image;
}

PairContext GrainContacts::context_of(const GrainFrame& a, const GrainFrame& b,
                                      double time_step) const {
  return {.effective_mass = a.mass * b.mass / (a.mass + b.mass),
          .friction = settings_.friction,
          .time_step = time_step};
}

/// Once the force of the nodes of a pair is known.
void GrainContacts::finish(std::size_t p, std::span<const GrainFrame> frames,
                           ContactCounters& counters) {
  if (bond_of_pair_[p] != no_bond) add_bond(p, frames);
  const PairForce& force = forces_[p];
  acts_[p] = force.holds() || force.friction != 0 || force.dashpot != 0 || force.fracture != 0;
  ++counters.due;
  counters.touching_nodes += force.touching;
  if (force.touching > 0) ++counters.touching_pairs;
}

void GrainContacts::keep_bond(std::size_t p, const Bond& bond) {
  bond_of_pair_[p] = static_cast<std::uint32_t>(bonds_.size());
  bonds_.push_back(bond);
  fates_.push_back(BondFate::holds);
  pair_of_bond_.push_back(static_cast<std::uint32_t>(p));
  if (engine_ != ContactEngine::near) return;
  LaneChunk& chunk = lanes_.chunk_of(p);
  chunk.activate(static_cast<std::uint32_t>(p - chunk.first));
}

/// A bond that breaks lets go at once; it is gone with commit().
void GrainContacts::add_bond(std::size_t p, std::span<const GrainFrame> frames) {
  const std::uint32_t bond = bond_of_pair_[p];
  std::optional<GrainFrame> image;
  const BondForce cement = settings_.bond->bond_force(bonds_[bond], frames[pairs_[p].slot_a],
                                                      image_of_b(p, frames, image));
  PairForce& pair = forces_[p];
  fates_[bond] = cement.fate;
  pair.bonded = cement.fate == BondFate::holds;
  if (!pair.bonded) {
    pair.fracture = cement.elastic;
    return;
  }
  pair.force_on_a += cement.force_on_a;
  pair.moment_a += cement.moment_a;
  pair.moment_b += cement.moment_b;
  pair.elastic += cement.elastic;
  pair.stiffness += static_cast<float>(settings_.bond->stiffness(bonds_[bond]));
}

void GrainContacts::set_bonds(std::span<const GrainFrame> frames) {
  std::array<std::vector<Touch>, 2> touches;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    if (forces_[p].touching == 0 || bond_of_pair_[p] != no_bond) continue;
    std::optional<GrainFrame> image;
    const GrainFrame& a = frames[pairs_[p].slot_a];
    const GrainFrame& b = image_of_b(p, frames, image);
    std::array<WeightedTouches, 2> sides;
    for_each_master(settings_.master, a, b, [&](bool master_is_b, double weight) {
      std::vector<Touch>& found = touches[master_is_b ? 1 : 0];
      found.clear();
      find_touches(master_is_b ? b : a, master_is_b ? a : b, found);
      sides[master_is_b ? 1 : 0] = {found, weight};
    });
    const auto bond = set_bond(*settings_.bond, a, b, sides[0], sides[1]);
    if (bond) keep_bond(p, *bond);
  }
}

bool GrainContacts::may_use_near_lists() {
  if (!displacements_.trustworthy()) forget_near_lists();
  return displacements_.trustworthy();
}

void GrainContacts::evaluate_part(bool with_ghosts, std::span<const GrainFrame> frames,
                                  double time_step) {
  if (engine_ == ContactEngine::near) {
    evaluate_near(frames, time_step, with_ghosts, may_use_near_lists());
  } else {
    evaluate_plainly(frames, time_step, with_ghosts);
  }
}

void GrainContacts::evaluate_interior(std::span<const GrainFrame> frames, double time_step,
                                      std::size_t owned) {
  owned_ = owned;
  if (engine_ == ContactEngine::near) {
    displacements_.begin(frames, cell_ ? &cell_motion_ : nullptr);
    displacements_.follow(frames, 0, owned);
  }
  store_.begin_writing(thread_count());
  scratch_.resize(static_cast<std::size_t>(thread_count()));
  evaluate_part(false, frames, time_step);
}

void GrainContacts::evaluate_border(std::span<const GrainFrame> frames, double time_step) {
  if (owned_ < frames.size()) {
    if (engine_ == ContactEngine::near) displacements_.follow(frames, owned_, frames.size());
    evaluate_part(true, frames, time_step);
  }
  ++counters_.evaluations;
  counters_.pairs += pairs_.size();
  for (Scratch& scratch : scratch_) {
    counters_ += scratch.counters;
    scratch.counters = {};
  }
}

void GrainContacts::forget_near_lists() {
  std::fill(next_check_.begin(), next_check_.end(), check_always);
  for (NearPair& pair : near_) pair = {};
}

Load GrainContacts::load_on(std::size_t slot, EnergyLedger& ledger) const {
  Load load;
  for (const auto& entry : pairs_of_grain_.of(slot)) {
    if (acts_[entry.pair] == 0) continue;
    const PairForce& pair = forces_[entry.pair];
    // A pair that is listed but does not touch adds nothing, not even a signed zero: the answer
    // must not depend on the list.
    if (pair.holds()) {
      load +=
          entry.is_a ? Load{pair.force_on_a, pair.moment_a} : Load{-pair.force_on_a, pair.moment_b};
    }
    if (entry.is_a) {
      if (pair.friction != 0) ledger.friction += pair.friction;
      if (pair.dashpot != 0) ledger.dashpot += pair.dashpot;
      if (pair.fracture != 0) ledger.fracture += pair.fracture;
    }
  }
  return load;
}

void GrainContacts::commit() {
  if (engine_ == ContactEngine::near) {
    lanes_.commit();
  } else {
    store_.commit();
    springs_of_pair_.swap(new_springs_of_pair_);
  }
  for (std::size_t bond = 0; bond < fates_.size(); ++bond) {
    if (fates_[bond] == BondFate::holds) continue;
    const std::uint32_t p = pair_of_bond_[bond];
    if (bond_of_pair_[p] != bond) continue;  // it broke before
    bond_of_pair_[p] = no_bond;
    if (pairs_[p].slot_a >= owned_) continue;
    ++(fates_[bond] == BondFate::breaks_in_tension ? broken_.in_tension : broken_.in_shear);
  }
}

std::size_t GrainContacts::bytes() const {
  const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  std::size_t sum = of(pairs_) + of(by_ids_) + of(pairs_of_grain_.first) +
                    of(pairs_of_grain_.entries) + of(springs_of_pair_) + of(new_springs_of_pair_) +
                    of(forces_) + of(acts_) + of(next_check_) + of(near_) + store_.bytes() +
                    lanes_.bytes() + of(bond_of_pair_) + of(bonds_) + of(fates_) +
                    of(pair_of_bond_);
  for (const NearPair& pair : near_) sum += pair.of_a.bytes() + pair.of_b.bytes();
  return sum;
}

std::vector<PairSprings> GrainContacts::springs() const {
  std::vector<PairSprings> all;
  auto adopted = adopted_.begin();
  for (const std::uint32_t p : by_ids_) {
    const auto ids = ids_of(pairs_[p]);
    for (; adopted != adopted_.end() && adopted->first < ids; ++adopted) {
      all.push_back(adopted->second);
    }
    PairSprings pair{ids.first, ids.second, springs_of(p)};
    if (bond_of_pair_[p] != no_bond) pair.bond = bonds_[bond_of_pair_[p]];
    if (adopted != adopted_.end() && adopted->first == ids) {
      if (pair.springs.empty()) pair.springs = adopted->second.springs;
      if (!pair.bond) pair.bond = adopted->second.bond;
      ++adopted;
    }
    if (!pair.springs.empty() || pair.bond) all.push_back(std::move(pair));
  }
  for (; adopted != adopted_.end(); ++adopted) all.push_back(adopted->second);
  return all;
}

void GrainContacts::adopt(std::span<const PairSprings> springs) {
  for (const PairSprings& pair : springs) {
    const auto [entry, added] = adopted_.try_emplace({pair.id_a, pair.id_b}, pair);
    if (added) continue;
    if (entry->second.springs.empty()) entry->second.springs = pair.springs;
    if (!entry->second.bond) entry->second.bond = pair.bond;
  }
}

}  // namespace reckon
