// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "reckon/core/peak_memory.hpp"
#include "reckon/domain/packing.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {
namespace {

/// Everybody's values on the root, in any order; nothing elsewhere.
template <class Value>
std::vector<Value> gather(const Communicator& ranks, const std::vector<Value>& own) {
  Bytes bytes;
  pack<Value>(bytes, own);
  std::vector<Value> all;
  for (const Bytes& part : ranks.gather(bytes)) {
    const auto values = Unpacker{part}.take_all<Value>();
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

/// The same for springs: `Entry` is PairSprings or WallSprings, `Key` two ids and a count.
template <class Entry, class Key>
std::vector<Entry> gather_springs(const Communicator& ranks, const std::vector<Entry>& own,
                                  Key (*key_of)(const Entry&), Entry (*entry_of)(const Key&)) {
  std::vector<Key> keys;
  std::vector<NodeSpring> springs;
  for (const Entry& entry : own) {
    keys.push_back(key_of(entry));
    springs.insert(springs.end(), entry.springs.begin(), entry.springs.end());
  }
  const std::vector<Key> all_keys = gather(ranks, keys);
  const std::vector<NodeSpring> all_springs = gather(ranks, springs);
  std::vector<Entry> all;
  auto next = all_springs.begin();
  for (const Key& key : all_keys) {
    Entry entry = entry_of(key);
    const auto end = next + static_cast<std::ptrdiff_t>(key.count);
    entry.springs.assign(next, end);
    next = end;
    all.push_back(std::move(entry));
  }
  return all;
}

struct PairKey {
  GrainId a, b;
  std::uint64_t count;
  bool bonded;
  Bond bond;
};
struct WallKey {
  GrainId grain;
  WallId wall;
  std::uint64_t count;
};

/// Where the line from a grain's centre meets the wall at a right angle.
Vec3 foot_on_wall(const Wall& wall, const WallPose& pose, const Vec3& center) {
  return std::visit(
      [&](const auto& surface) {
        const Vec3 p = center - pose.displacement;
        return center - surface.distance(p) * surface.gradient(p);
      },
      wall.surface);
}

}  // namespace

std::vector<GrainState> Simulation::grain_states() {
  update();
  receive_ghosts();
  std::vector<GrainState> own;
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) own.push_back(grains_.state(slot));
  std::vector<GrainState> all = gather(distribution_.ranks(), own);
  std::sort(all.begin(), all.end(),
            [](const GrainState& a, const GrainState& b) { return a.id < b.id; });
  return all;
}

SimulationState Simulation::state() {
  SimulationState state;
  state.step = step_;
  state.grains = grain_states();
  const Communicator& ranks = distribution_.ranks();
  // A pair that two ranks share is told by the owner of its first grain.
  std::vector<PairSprings> own_springs;
  std::vector<GrainId> own_ids = grains_.id;
  std::sort(own_ids.begin(), own_ids.end());
  for (PairSprings& pair : interactions_.grains().springs()) {
    if (std::binary_search(own_ids.begin(), own_ids.end(), pair.id_a)) {
      own_springs.push_back(std::move(pair));
    }
  }
  state.pair_springs = gather_springs<PairSprings, PairKey>(
      ranks, own_springs,
      [](const PairSprings& p) {
        return PairKey{p.id_a, p.id_b, p.springs.size(), p.bond.has_value(),
                       p.bond.value_or(Bond{})};
      },
      [](const PairKey& key) {
        PairSprings pair{key.a, key.b, {}};
        if (key.bonded) pair.bond = key.bond;
        return pair;
      });
  state.wall_springs = gather_springs<WallSprings, WallKey>(
      ranks, interactions_.walls().springs(),
      [](const WallSprings& w) {
        return WallKey{w.grain, w.wall, w.springs.size()};
      },
      [](const WallKey& key) {
        return WallSprings{key.grain, key.wall, {}};
      });
  state.departed = gather(ranks, departed_);
  for (const BrokenBonds& broken :
       gather(ranks, std::vector{interactions_.grains().broken_bonds()})) {
    state.broken_bonds.in_tension += broken.in_tension;
    state.broken_bonds.in_shear += broken.in_shear;
  }
  if (ranks.is_root()) {
    state.stage_starts = stage_starts_;
    container_.save(state);
  }
  std::sort(state.departed.begin(), state.departed.end(),
            [](const DepartedGrain& a, const DepartedGrain& b) { return a.grain.id < b.grain.id; });
  std::sort(state.pair_springs.begin(), state.pair_springs.end(),
            [](const PairSprings& p, const PairSprings& q) {
              return p.id_a != q.id_a ? p.id_a < q.id_a : p.id_b < q.id_b;
            });
  std::sort(state.wall_springs.begin(), state.wall_springs.end(),
            [](const WallSprings& s, const WallSprings& t) {
              return s.grain != t.grain ? s.grain < t.grain : s.wall < t.wall;
            });
  return state;
}

std::vector<RankPerformance> Simulation::performance() const {
  RankPerformance own = done_;
  own.communication = distribution_.counters();
  own.peak_memory = peak_memory();
  own.shape_bytes = setup_.shapes.resident_bytes();
  own.rank_on_machine = static_cast<std::uint64_t>(setup_.shapes.rank_on_machine());
  own.threads = static_cast<std::uint64_t>(thread_count());
  return gather(distribution_.ranks(), std::vector<RankPerformance>{own});
}

std::vector<ContactRecord> Simulation::contacts() {
  update();
  compute_forces();
  std::vector<ContactRecord> records;
  interactions_.visit_contacts([&](const ContactView& contact) {
    if (contact.slot >= grains_.size()) return;  // the owner of its first grain has it
    const Vec3& position = grains_.position[contact.slot];
    const Vec3 from = container_.wrapped(position);
    Vec3 to = contact.membrane_place;
    std::uint32_t partner = contact.other;
    switch (contact.partner) {
      case ContactPartner::grain:
        to = from - container_.branch(position, frames_[contact.other].position);
        partner = frames_[contact.other].id.get();
        break;
      case ContactPartner::wall:
        to = foot_on_wall(setup_.walls[partner], container_.poses()[partner], from);
        break;
      case ContactPartner::membrane:
        partner = static_cast<std::uint32_t>(setup_.walls.size());
        break;
    }
    records.push_back({grains_.id[contact.slot], contact.partner != ContactPartner::grain, partner,
                       from, to, contact.force, contact.deepest, contact.touching, contact.bonded});
  });
  records = gather(distribution_.ranks(), records);
  std::sort(records.begin(), records.end(), [](const ContactRecord& r, const ContactRecord& s) {
    if (r.with_wall != s.with_wall) return !r.with_wall;
    return r.grain != s.grain ? r.grain < s.grain : r.partner < s.partner;
  });
  return records;
}

}  // namespace reckon
