// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/grain_contacts.hpp"

#include <algorithm>
#include <map>
#include <type_traits>
#include <utility>

#include "reckon/contact/near_skin.hpp"
#include "reckon/contact/pair_kernel.hpp"
#include "reckon/contact/visit_awake.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

RigidMotion motion_of(const GrainFrame& grain) {
  return {grain.position, grain.velocity, grain.angular_velocity_world};
}

void add_directed(PairForce& pair, const DirectedForce& directed, bool master_is_b) {
  pair.force_on_a += master_is_b ? -directed.force : directed.force;
  pair.moment_a += master_is_b ? directed.moment_slave : directed.moment_master;
  pair.moment_b += master_is_b ? directed.moment_master : directed.moment_slave;
  pair.deepest = std::max(pair.deepest, directed.deepest);
  pair.elastic += directed.elastic;
  pair.friction += directed.friction;
  pair.dashpot += directed.dashpot;
  pair.touching += directed.touching;
}

bool ids_less(GrainId a1, GrainId b1, GrainId a2, GrainId b2) {
  return a1 != a2 ? a1 < a2 : b1 < b2;
}

}  // namespace

void GrainContacts::rebuild(std::vector<Pair> pairs, std::size_t slot_count) {
  std::vector<SpringRange> springs(pairs.size());
  std::vector<double> wake(pairs.size(), wake_always);
  std::vector<NearPair> near(pairs.size());
  std::size_t old = 0;  // both lists are sorted by ids
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    while (old < pairs_.size() &&
           ids_less(pairs_[old].id_a, pairs_[old].id_b, pairs[p].id_a, pairs[p].id_b)) {
      ++old;
    }
    if (old < pairs_.size() && pairs_[old].id_a == pairs[p].id_a &&
        pairs_[old].id_b == pairs[p].id_b) {
      springs[p] = springs_of_pair_[old];
      wake[p] = wake_[old];
      near[p] = std::move(near_[old]);
    }
  }
  pairs_ = std::move(pairs);
  springs_of_pair_ = std::move(springs);
  wake_ = std::move(wake);
  near_ = std::move(near);
  // A sleeping pair writes neither.
  new_springs_of_pair_.assign(pairs_.size(), {});
  forces_.assign(pairs_.size(), {});
  acts_.assign(pairs_.size(), 0);
  pairs_of_grain_ = index_pairs(pairs_, slot_count);
}

template <ContactLaw Law, class Find>
PairForce GrainContacts::evaluate_pair(const Law& law, const GrainFrame& a, const GrainFrame& b,
                                       std::span<const NodeSpring> old_springs, double time_step,
                                       Find&& find, std::vector<Touch>& touches,
                                       std::vector<NodeSpring>& new_springs) const {
  PairForce pair;
  const PairContext context{.effective_mass = a.mass * b.mass / (a.mass + b.mass),
                            .friction = settings_.friction,
                            .time_step = time_step};
  const auto first_of_b = std::find_if(old_springs.begin(), old_springs.end(),
                                       [](const NodeSpring& s) { return s.master_is_b; });
  const auto a_count = static_cast<std::size_t>(first_of_b - old_springs.begin());
  const auto directed = [&](bool master_is_b, double weight) {
    const GrainFrame& master = master_is_b ? b : a;
    const GrainFrame& slave = master_is_b ? a : b;
    touches.clear();
    find(master, slave, master_is_b, touches);
    const auto old = master_is_b ? old_springs.subspan(a_count) : old_springs.first(a_count);
    if (touches.empty() && old.empty()) return;
    add_directed(pair,
                 respond(law, context, master.position, motion_of(master), motion_of(slave),
                         touches, old, *master.shape, master_is_b, weight, new_springs),
                 master_is_b);
  };
  switch (settings_.master) {
    case MasterRule::lower_id:
      directed(false, 1);
      break;
    case MasterRule::smaller:
      directed(b.shape->bounding_radius < a.shape->bounding_radius, 1);
      break;
    case MasterRule::both:
      directed(false, 0.5);
      directed(true, 0.5);
      break;
  }
  return pair;
}

template <ContactLaw Law>
void GrainContacts::evaluate_listed(const Law& law, std::size_t p,
                                    std::span<const GrainFrame> frames, double time_step,
                                    std::optional<double> odometer, Scratch& scratch) {
  const Pair& pair = pairs_[p];
  const auto old_springs = store_.read(springs_of_pair_[p]);
  double wake = odometer ? wake_never : wake_always;
  const auto find = [&](const GrainFrame& master, const GrainFrame& slave, bool master_is_b,
                        std::vector<Touch>& touches) {
    if (!odometer) {
      find_touches(master, slave, touches);
      return;
    }
    NearList& list = master_is_b ? near_[p].of_b : near_[p].of_a;
    wake = std::min(
        wake, list.find_touches(master, slave, *odometer, filter_, touches, scratch.counters));
  };
  new_springs_of_pair_[p] = store_.append([&](std::vector<NodeSpring>& arena) {
    forces_[p] = evaluate_pair(law, frames[pair.slot_a], frames[pair.slot_b], old_springs,
                               time_step, find, scratch.touches, arena);
  });
  // A pair that lets go of springs is looked at once more, so that both buffers are empty when it
  // falls asleep.
  wake_[p] = old_springs.empty() ? wake : wake_always;
  const PairForce& force = forces_[p];
  acts_[p] = force.touching > 0 || force.friction != 0 || force.dashpot != 0 ? 1 : 0;
  ++scratch.counters.awake;
  scratch.counters.touching_nodes += force.touching;
  if (force.touching > 0) ++scratch.counters.touching_pairs;
}

template <ContactLaw Law>
void GrainContacts::evaluate_pairs(const Law& law, Part part, std::span<const GrainFrame> frames,
                                   double time_step, bool use_near_lists) {
  const auto scratch = [&]() -> Scratch& {
    return scratch_[static_cast<std::size_t>(thread_index())];
  };
  if (!use_near_lists) {
    parallel_for(pairs_.size(), 32, [&](std::size_t p) {
      if (part.has(pairs_[p])) evaluate_listed(law, p, frames, time_step, {}, scratch());
    });
    return;
  }
  const std::span<const double> travelled = meter_.travelled();
  visit_awake(
      wake_, [&](std::size_t p) { return part.has(pairs_[p]); },
      [&](std::size_t p) { return travelled[pairs_[p].slot_a] + travelled[pairs_[p].slot_b]; },
      [&](std::size_t p) { prefetch(p, frames); },
      [&](std::size_t p, double odometer) {
        evaluate_listed(law, p, frames, time_step, odometer, scratch());
      });
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
  if (!meter_.trustworthy()) forget_near_lists();
  return meter_.trustworthy();
}

void GrainContacts::evaluate(std::span<const GrainFrame> frames, double time_step,
                             std::size_t owned, const std::function<void()>& others_arrive) {
  const bool uses_meter = engine_ == ContactEngine::near;
  if (uses_meter) {
    meter_.begin(frames);
    meter_.follow(frames, 0, owned);
  }
  store_.begin_writing(thread_count());
  scratch_.resize(static_cast<std::size_t>(thread_count()));
  const auto evaluate_part = [&](bool with_others) {
    const Part part{static_cast<std::uint32_t>(owned), with_others};
    const bool near = may_use_near_lists();
    std::visit([&](const auto& law) { evaluate_pairs(law, part, frames, time_step, near); },
               settings_.law);
  };
  evaluate_part(false);
  others_arrive();
  if (owned < frames.size()) {
    if (uses_meter) meter_.follow(frames, owned, frames.size());
    evaluate_part(true);
  }
  ++counters_.evaluations;
  counters_.pairs += pairs_.size();
  for (Scratch& scratch : scratch_) {
    counters_ += scratch.counters;
    scratch.counters = {};
  }
}

void GrainContacts::forget_near_lists() {
  std::fill(wake_.begin(), wake_.end(), wake_always);
  for (NearPair& pair : near_) pair = {};
}

void GrainContacts::add_loads(std::span<Load> loads, std::span<EnergyLedger> ledgers) const {
  parallel_for(loads.size(), 64, [&](std::size_t slot) {
    for (const auto& entry : pairs_of_grain_.of(slot)) {
      if (acts_[entry.pair] == 0) continue;
      const PairForce& pair = forces_[entry.pair];
      // A pair that is listed but does not touch adds nothing, not even a signed zero: the answer
      // must not depend on the list.
      if (pair.touching > 0) {
        loads[slot] += entry.is_a ? Load{pair.force_on_a, pair.moment_a}
                                  : Load{-pair.force_on_a, pair.moment_b};
      }
      if (entry.is_a) {
        if (pair.friction != 0) ledgers[slot].friction += pair.friction;
        if (pair.dashpot != 0) ledgers[slot].dashpot += pair.dashpot;
      }
    }
  });
}

void GrainContacts::commit() {
  store_.commit();
  springs_of_pair_.swap(new_springs_of_pair_);
}

std::size_t GrainContacts::bytes() const {
  const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  std::size_t sum = of(pairs_) + of(pairs_of_grain_.first) + of(pairs_of_grain_.entries) +
                    of(springs_of_pair_) + of(new_springs_of_pair_) + of(forces_) + of(acts_) +
                    of(wake_) + of(near_) + store_.bytes();
  for (const NearPair& pair : near_) sum += pair.of_a.bytes() + pair.of_b.bytes();
  return sum;
}

std::vector<PairSprings> GrainContacts::springs() const {
  std::vector<PairSprings> all;
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const auto springs = store_.read(springs_of_pair_[p]);
    if (springs.empty()) continue;
    all.push_back({pairs_[p].id_a, pairs_[p].id_b, {springs.begin(), springs.end()}});
  }
  return all;
}

void GrainContacts::adopt(std::span<const PairSprings> springs) {
  std::map<std::pair<GrainId, GrainId>, std::size_t> listed;
  for (std::size_t p = 0; p < pairs_.size(); ++p) listed[{pairs_[p].id_a, pairs_[p].id_b}] = p;
  for (const PairSprings& pair : springs) {
    const auto [entry, added] = listed.try_emplace({pair.id_a, pair.id_b}, pairs_.size());
    if (added) {
      pairs_.push_back({pair.id_a, pair.id_b, 0, 0});
      springs_of_pair_.emplace_back();
      wake_.push_back(wake_always);
      near_.emplace_back();
    }
    const std::size_t p = entry->second;
    if (springs_of_pair_[p].count > 0) continue;  // both ranks of a pair hold the same springs
    springs_of_pair_[p] = store_.adopt(pair.springs);
    wake_[p] = wake_always;
  }
  // Back into the order of the ids, which rebuild() relies on.
  std::vector<std::size_t> order;
  order.reserve(listed.size());
  for (const auto& [ids, p] : listed) order.push_back(p);
  const auto reorder = [&order](auto& values) {
    std::remove_reference_t<decltype(values)> sorted;
    for (const std::size_t p : order) sorted.push_back(std::move(values[p]));
    values = std::move(sorted);
  };
  reorder(pairs_);
  reorder(springs_of_pair_);
  reorder(wake_);
  reorder(near_);
}

}  // namespace reckon
