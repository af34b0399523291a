// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/pair_lanes.hpp"

#include <algorithm>
#include <utility>

#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

using Slot = SlotLists::Slot;

struct Lane {
  std::size_t block;
  std::size_t lane;

  explicit Lane(Slot slot) : block{slot / lane_count}, lane{slot % lane_count} {}
};

/// Everything but the node, the list and the grains.
void copy_lane(const NodeLanes& from, std::size_t i, NodeLanes& to, std::size_t j) {
  to.place_body.set(j, from.place_body[i]);
  to.area[j] = from.area[i];
  for (std::size_t c = 0; c < from.polynomial.size(); ++c) {
    to.polynomial[c][j] = from.polynomial[c][i];
  }
  to.cell.set(j, from.cell[i]);
  to.grid_origin.set(j, from.grid_origin[i]);
  to.inverse_spacing[j] = from.inverse_spacing[i];
  to.radius_squared[j] = from.radius_squared[i];
  to.both_radii_squared[j] = from.both_radii_squared[i];
  for (std::size_t s = 0; s < from.springs.size(); ++s) {
    to.springs[s].set(j, from.springs[s].get(i, from.node[i], false));
  }
}

/// Copies the nodes of one pair behind those that `to` has already.
void copy_pair(const LaneChunk& from, std::size_t k_from, LaneChunk& to, std::size_t k_to,
               const Pair& pair) {
  for (const std::size_t side : {0U, 1U}) {
    Slot last = SlotLists::none;
    for (Slot slot = from.lists.first(2 * k_from + side); slot != SlotLists::none;
         slot = from.lists.next(slot)) {
      last = to.insert(2 * k_to + side, from.lists.key(slot), pair, last);
      const Lane old{slot};
      const Lane now{last};
      copy_lane(from.lanes[old.block], old.lane, to.lanes[now.block], now.lane);
    }
  }
}

bool has_nodes(const LaneChunk& chunk, std::size_t k) {
  return chunk.lists.first(2 * k) != SlotLists::none ||
         chunk.lists.first(2 * k + 1) != SlotLists::none;
}

}  // namespace

Slot LaneChunk::insert(std::size_t list, NodeIndex node, const Pair& pair, Slot after) {
  const Slot slot = lists.insert(list, node, after);
  const Lane at{slot};
  if (at.block == lanes.size()) {
    lanes.emplace_back();
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      lanes.back().cell.x[lane] = NodeLanes::no_cell;
    }
  }
  NodeLanes& block = lanes[at.block];
  const bool b_is_master = list % 2 == 1;
  block.cell.x[at.lane] = NodeLanes::no_cell;
  for (LaneSprings& springs : block.springs) springs.set(at.lane, {});
  block.master[at.lane] = b_is_master ? pair.slot_b : pair.slot_a;
  block.slave[at.lane] = b_is_master ? pair.slot_a : pair.slot_b;
  block.node[at.lane] = node;
  block.list[at.lane] = static_cast<std::uint32_t>(list);
  return slot;
}

void LaneChunk::remove(Slot slot) {
  const Lane at{slot};
  lists.remove(lanes[at.block].list[at.lane], slot);
  lanes[at.block].cell.x[at.lane] = NodeLanes::no_cell;
}

void LaneChunk::activate(std::uint32_t k) {
  const auto place = std::lower_bound(active.begin(), active.end(), k);
  if (place == active.end() || *place != k) active.insert(place, k);
}

void PairLanes::rebuild(std::span<const Pair> pairs, std::size_t interior,
                        std::span<const std::uint32_t> old_pairs) {
  for (LaneChunk& chunk : chunks_) remove_leaving(chunk);
  // Large chunks fill their lanes better; small ones share few pairs out evenly among threads.
  constexpr std::size_t smallest = 16;
  constexpr std::size_t largest = 128;
  const std::size_t even = pairs.size() / (8 * static_cast<std::size_t>(thread_count()));
  const std::size_t pairs_per_chunk = std::clamp(even, smallest, largest);
  const auto chunks_for = [&](std::size_t count) {
    return (count + pairs_per_chunk - 1) / pairs_per_chunk;
  };
  const std::size_t interior_chunks = chunks_for(interior);
  std::vector<LaneChunk> chunks(interior_chunks + chunks_for(pairs.size() - interior));
  parallel_for(chunks.size(), 1, [&](std::size_t c) {
    LaneChunk& chunk = chunks[c];
    const bool is_interior = c < interior_chunks;
    chunk.first =
        is_interior ? c * pairs_per_chunk : interior + (c - interior_chunks) * pairs_per_chunk;
    chunk.count = std::min(pairs_per_chunk, (is_interior ? interior : pairs.size()) - chunk.first);
    chunk.lists = SlotLists{2 * chunk.count};
    for (std::size_t k = 0; k < chunk.count; ++k) {
      const std::uint32_t old = old_pairs[chunk.first + k];
      if (old == new_pair) continue;
      const LaneChunk& from = chunk_of(old);
      copy_pair(from, old - from.first, chunk, k, pairs[chunk.first + k]);
      if (has_nodes(chunk, k)) chunk.active.push_back(static_cast<std::uint32_t>(k));
      chunk.has_spheres |= from.has_spheres;
    }
    chunk.evaluated_after = commits_;
  });
  chunks_ = std::move(chunks);
  pairs_per_chunk_ = pairs_per_chunk;
  interior_ = interior;
  interior_chunks_ = interior_chunks;
}

void PairLanes::begin(LaneChunk& chunk) {
  remove_leaving(chunk);
  chunk.leaving.clear();
  chunk.evaluated_after = commits_;
  if (!chunk.lists.is_sparse()) return;
  LaneChunk packed;
  packed.lists = SlotLists{2 * chunk.count};
  for (std::size_t k = 0; k < chunk.count; ++k) {
    const Slot first = chunk.lists.first(2 * k);
    const Slot slot = first != SlotLists::none ? first : chunk.lists.first(2 * k + 1);
    if (slot == SlotLists::none) continue;
    const NodeLanes& lanes = chunk.lanes[slot / lane_count];
    const std::size_t lane = slot % lane_count;
    Pair pair{{}, {}, lanes.master[lane], lanes.slave[lane]};
    if (first == SlotLists::none) std::swap(pair.slot_a, pair.slot_b);
    copy_pair(chunk, k, packed, k, pair);
  }
  chunk.lists = std::move(packed.lists);
  chunk.lanes = std::move(packed.lanes);
}

void PairLanes::remove_leaving(LaneChunk& chunk) const {
  if (chunk.evaluated_after == commits_) return;
  for (const Slot slot : chunk.leaving) chunk.remove(slot);
  chunk.leaving.clear();
}

std::vector<NodeSpring> PairLanes::springs(std::size_t pair) const {
  std::vector<NodeSpring> found;
  const LaneChunk& chunk = chunk_of(pair);
  for (const std::size_t side : {0U, 1U}) {
    for (Slot slot = chunk.lists.first(2 * (pair - chunk.first) + side); slot != SlotLists::none;
         slot = chunk.lists.next(slot)) {
      const Lane at{slot};
      const LaneSprings& springs = chunk.lanes[at.block].springs[1 - now_];
      if (springs.exists(at.lane)) {
        found.push_back(springs.get(at.lane, chunk.lists.key(slot), side == 1));
      }
    }
  }
  return found;
}

void PairLanes::adopt(const Pair& listed, std::size_t pair, std::span<const NodeSpring> springs) {
  LaneChunk& chunk = chunk_of(pair);
  const std::size_t k = pair - chunk.first;
  for (const NodeSpring& spring : springs) {
    const Lane at{chunk.insert(2 * k + (spring.master_is_b ? 1 : 0), spring.node, listed)};
    chunk.lanes[at.block].springs[1 - now_].set(at.lane, spring);
  }
  if (!springs.empty()) chunk.activate(static_cast<std::uint32_t>(k));
}

std::size_t PairLanes::bytes() const {
  std::size_t sum = chunks_.capacity() * sizeof(LaneChunk);
  for (const LaneChunk& chunk : chunks_) {
    sum += chunk.lists.bytes() + chunk.lanes.capacity() * sizeof(NodeLanes) +
           chunk.active.capacity() * sizeof(chunk.active[0]) +
           chunk.leaving.capacity() * sizeof(chunk.leaving[0]);
  }
  return sum;
}

}  // namespace reckon
