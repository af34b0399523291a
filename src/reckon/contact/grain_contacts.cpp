// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/grain_contacts.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include "reckon/contact/near_skin.hpp"
#include "reckon/contact/pair_kernel.hpp"
#include "reckon/contact/sphere_contact.hpp"
#include "reckon/contact/visit_due.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

void add_directed(PairForce& pair, const DirectedForce& directed, bool master_is_b) {
  pair.force_on_a += master_is_b ? -directed.force : directed.force;
  pair.moment_a += master_is_b ? directed.moment_slave : directed.moment_master;
  pair.moment_b += master_is_b ? directed.moment_master : directed.moment_slave;
  pair.deepest = std::max(pair.deepest, directed.deepest);
  pair.elastic += directed.elastic;
  pair.friction += directed.friction;
  pair.dashpot += directed.dashpot;
  pair.stiffness += static_cast<float>(directed.stiffness);
  pair.damping += static_cast<float>(directed.damping);
  pair.touching += directed.touching;
}

/// Calls body(master_is_b, weight) for each way in which a pair is looked at.
template <class Body>
void for_each_master(MasterRule rule, const GrainFrame& a, const GrainFrame& b, Body&& body) {
  switch (rule) {
    case MasterRule::lower_id:
      body(false, 1.0);
      break;
    case MasterRule::smaller:
      body(b.shape->bounding_radius < a.shape->bounding_radius, 1.0);
      break;
    case MasterRule::both: {
      if (are_spheres(a, b)) return body(false, 1.0);  // both ways are the same
      const double sum = a.shape->mean_node_area + b.shape->mean_node_area;
      body(false, b.shape->mean_node_area / sum);
      body(true, a.shape->mean_node_area / sum);
      break;
    }
  }
}

/// A pair's springs by master: a's come first.
class SidedSprings {
 public:
  explicit SidedSprings(std::span<const NodeSpring> springs) : springs_{springs} {
    const auto is_of_b = [](const NodeSpring& spring) { return spring.master_is_b; };
    const auto first_of_b = std::find_if(springs.begin(), springs.end(), is_of_b);
    of_a_ = static_cast<std::size_t>(first_of_b - springs.begin());
  }
  [[nodiscard]] bool empty() const { return springs_.empty(); }
  [[nodiscard]] std::span<const NodeSpring> of(bool master_is_b) const {
    return master_is_b ? springs_.subspan(of_a_) : springs_.first(of_a_);
  }

 private:
  std::span<const NodeSpring> springs_;
  std::size_t of_a_;
};

bool ids_less(GrainId a1, GrainId b1, GrainId a2, GrainId b2) {
  return a1 != a2 ? a1 < a2 : b1 < b2;
}

}  // namespace

void GrainContacts::rebuild(std::vector<Pair> pairs, std::size_t slot_count) {
  // By ids first, as the old ones can be gone through, then by slots.
  std::vector<std::uint32_t> by_slots(pairs.size());
  std::iota(by_slots.begin(), by_slots.end(), 0U);
  const auto slots = [&](std::uint32_t p) { return std::minmax(pairs[p].slot_a, pairs[p].slot_b); };
  std::sort(by_slots.begin(), by_slots.end(),
            [&](std::uint32_t p, std::uint32_t q) { return slots(p) < slots(q); });
  std::vector<std::uint32_t> by_ids(pairs.size());
  for (std::uint32_t place = 0; place < by_slots.size(); ++place) by_ids[by_slots[place]] = place;

  std::vector<Pair> listed(pairs.size());
  std::vector<SpringRange> springs(pairs.size());
  std::vector<double> next_check(pairs.size(), check_always);
  std::vector<NearPair> near(pairs.size());
  std::vector<Vec3> images(cell_ ? pairs.size() : 0);
  const auto old_bonds = std::exchange(bonds_, {});
  const auto old_bond_of_pair = std::exchange(bond_of_pair_, {});
  fates_.clear();
  pair_of_bond_.clear();
  bond_of_pair_.assign(pairs.size(), no_bond);
  auto old = by_ids_.begin();
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const std::uint32_t place = by_ids[p];
    listed[place] = pairs[p];
    while (old != by_ids_.end() &&
           ids_less(pairs_[*old].id_a, pairs_[*old].id_b, pairs[p].id_a, pairs[p].id_b)) {
      ++old;
    }
    if (old != by_ids_.end() && pairs_[*old].id_a == pairs[p].id_a &&
        pairs_[*old].id_b == pairs[p].id_b) {
      springs[place] = springs_of_pair_[*old];
      next_check[place] = next_check_[*old];
      near[place] = std::move(near_[*old]);
      if (*old < images_.size() && cell_) images[place] = images_[*old];
      if (const auto bond = old_bond_of_pair[*old]; bond != no_bond) {
        keep_bond(place, old_bonds[bond]);
      }
    }
  }
  pairs_ = std::move(listed);
  by_ids_ = std::move(by_ids);
  springs_of_pair_ = std::move(springs);
  next_check_ = std::move(next_check);
  near_ = std::move(near);
  images_ = std::move(images);
  // A pair that is skipped writes neither.
  new_springs_of_pair_.assign(pairs_.size(), {});
  forces_.assign(pairs_.size(), {});
  acts_.assign(pairs_.size(), 0);
  pairs_of_grain_ = index_pairs(pairs_, by_ids_, slot_count);
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

/// What the force of a pair means for the next step, once that of its nodes is known. `next_check`:
/// by its near lists.
void GrainContacts::settle(std::size_t p, std::span<const GrainFrame> frames, double next_check,
                           bool had_springs, ContactCounters& counters) {
  const bool had_bond = bond_of_pair_[p] != no_bond;
  if (had_bond) add_bond(p, frames);
  // A pair that lost springs is evaluated once more, so that both buffers are empty when it is
  // skipped.
  next_check_[p] = had_springs || had_bond ? check_always : next_check;
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
    if (!bond) continue;
    keep_bond(p, *bond);
    next_check_[p] = check_always;
  }
}

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
  settle(p, frames, check_always, !old.empty(), scratch.counters);
}

/// Finds the touching nodes of a pair by its near lists and lets them wait for their law.
void GrainContacts::find_nodes(std::size_t p, std::span<const GrainFrame> frames, double time_step,
                               double path_length, Scratch& scratch) {
  std::optional<GrainFrame> image;
  const GrainFrame& a = frames[pairs_[p].slot_a];
  const GrainFrame& b = image_of_b(p, frames, image);
  const SidedSprings old{store_.read(springs_of_pair_[p])};
  const PairContext context = context_of(a, b, time_step);
  double next_check = check_never;
  for_each_master(settings_.master, a, b, [&](bool master_is_b, double) {
    const GrainFrame& master = master_is_b ? b : a;
    const GrainFrame& slave = master_is_b ? a : b;
    NearList& list = master_is_b ? near_[p].of_b : near_[p].of_a;
    scratch.touches.clear();
    next_check = std::min(next_check, list.find_touches(master, slave, path_length, filter_,
                                                        scratch.touches, scratch.counters));
    scratch.batch.add(context, master.position, motion_of(master), motion_of(slave),
                      scratch.touches, old.of(master_is_b));
  });
  if (cell_) {  // soon enough for the images that were not looked at
    const double both_radii = a.shape->bounding_radius + b.shape->bounding_radius;
    next_check = std::min(next_check, path_length + (image_distance_ - both_radii));
  }
  scratch.waiting.push_back({p, next_check});
}

/// The forces of the pairs that wait.
template <ContactLaw Law>
void GrainContacts::answer_waiting(const Law& law, std::span<const GrainFrame> frames,
                                   double time_step, Scratch& scratch) {
  scratch.batch.evaluate(settings_.law, settings_.friction, time_step, lanes_);
  std::size_t member = 0;
  for (const Waiting& waiting : scratch.waiting) {
    const std::size_t p = waiting.pair;
    const GrainFrame& a = frames[pairs_[p].slot_a];
    const GrainFrame& b = frames[pairs_[p].slot_b];
    const SidedSprings old{store_.read(springs_of_pair_[p])};
    PairForce pair;
    new_springs_of_pair_[p] = store_.append([&](std::vector<NodeSpring>& arena) {
      for_each_master(settings_.master, a, b, [&](bool master_is_b, double weight) {
        add_directed(
            pair, scratch.batch.sum(member++, law, old.of(master_is_b), master_is_b, weight, arena),
            master_is_b);
      });
    });
    forces_[p] = pair;
    settle(p, frames, waiting.next_check, !old.empty(), scratch.counters);
  }
  scratch.waiting.clear();
  scratch.batch.clear();
}

template <ContactLaw Law>
void GrainContacts::evaluate_pairs(const Law& law, Part part, std::span<const GrainFrame> frames,
                                   double time_step, bool use_near_lists) {
  const auto scratch = [&]() -> Scratch& {
    return scratch_[static_cast<std::size_t>(thread_index())];
  };
  if (!use_near_lists) {
    parallel_for(pairs_.size(), 32, [&](std::size_t p) {
      if (part.has(pairs_[p])) evaluate_plainly(law, p, frames, time_step, scratch());
    });
    return;
  }
  const std::span<const double> travelled = displacements_.path_lengths();
  visit_due(
      next_check_, [&](std::size_t p) { return part.has(pairs_[p]); },
      [&](std::size_t p) { return travelled[pairs_[p].slot_a] + travelled[pairs_[p].slot_b]; },
      [&](std::size_t p) { prefetch(p, frames); },
      [&](std::size_t p, double path_length) {
        find_nodes(p, frames, time_step, path_length, scratch());
      },
      [&] { answer_waiting(law, frames, time_step, scratch()); });
}

void GrainContacts::prefetch(std::size_t p, std::span<const GrainFrame> frames) const {
  near_[p].of_a.prefetch();
  near_[p].of_b.prefetch();
  prefetch_frame(frames[pairs_[p].slot_b]);
  __builtin_prefetch(&forces_[p], 1);
  __builtin_prefetch(reinterpret_cast<const char*>(&forces_[p]) + 64, 1);
}

bool GrainContacts::may_use_near_lists() {
  if (engine_ != ContactEngine::near) return false;
  if (!displacements_.trustworthy()) forget_near_lists();
  return displacements_.trustworthy();
}

void GrainContacts::evaluate_part(bool with_others, std::span<const GrainFrame> frames,
                                  double time_step) {
  const Part part{static_cast<std::uint32_t>(owned_), with_others};
  const bool near = may_use_near_lists();
  std::visit([&](const auto& law) { evaluate_pairs(law, part, frames, time_step, near); },
             settings_.law);
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
  store_.commit();
  springs_of_pair_.swap(new_springs_of_pair_);
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
                    of(bond_of_pair_) + of(bonds_) + of(fates_) + of(pair_of_bond_);
  for (const NearPair& pair : near_) sum += pair.of_a.bytes() + pair.of_b.bytes();
  return sum;
}

std::vector<PairSprings> GrainContacts::springs() const {
  std::vector<PairSprings> all;
  for (const std::uint32_t p : by_ids_) {
    const auto springs = store_.read(springs_of_pair_[p]);
    const std::uint32_t bond = bond_of_pair_[p];
    if (springs.empty() && bond == no_bond) continue;
    all.push_back({pairs_[p].id_a, pairs_[p].id_b, {springs.begin(), springs.end()}});
    if (bond != no_bond) all.back().bond = bonds_[bond];
  }
  return all;
}

void GrainContacts::adopt(std::span<const PairSprings> springs) {
  std::map<std::pair<GrainId, GrainId>, std::uint32_t> listed;
  for (const std::uint32_t p : by_ids_) listed[{pairs_[p].id_a, pairs_[p].id_b}] = p;
  for (const PairSprings& pair : springs) {
    const auto place = static_cast<std::uint32_t>(pairs_.size());
    const auto [entry, added] = listed.try_emplace({pair.id_a, pair.id_b}, place);
    if (added) {
      pairs_.push_back({pair.id_a, pair.id_b, 0, 0});
      springs_of_pair_.emplace_back();
      bond_of_pair_.push_back(no_bond);
      next_check_.push_back(check_always);
      near_.emplace_back();
      if (cell_) images_.emplace_back();
    }
    const std::uint32_t p = entry->second;
    if (pair.bond && bond_of_pair_[p] == no_bond) keep_bond(p, *pair.bond);
    if (springs_of_pair_[p].count > 0) continue;  // both ranks of a pair hold the same springs
    springs_of_pair_[p] = store_.adopt(pair.springs);
    next_check_[p] = check_always;
  }
  by_ids_.clear();
  for (const auto& [ids, p] : listed) by_ids_.push_back(p);
}

}  // namespace reckon
