// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reckon/contact/node_lanes.hpp"
#include "reckon/contact/slot_lists.hpp"
#include "reckon/contact/spring_store.hpp"
#include "reckon/neighbor/pair_list.hpp"

namespace reckon {

/// The touching nodes of some consecutive pairs. List 2k holds those of grain a of
/// the chunk's pair k in node order, list 2k + 1 those of grain b. One thread at a time works on a
/// chunk.
///
///   lists:   which slots belong to a pair, by node
///   lanes:   what is known of the node in each slot, eight slots side by side
struct LaneChunk {
  std::size_t first{0};  ///< pair
  std::size_t count{0};  ///< pairs
  SlotLists lists;
  std::vector<NodeLanes> lanes;
  /// Pairs, as k, that have nodes or a bond, or had some at the last evaluation; ascending.
  std::vector<std::uint32_t> active;
  /// Nodes that let go at the last evaluation. They are removed once that is committed.
  std::vector<SlotLists::Slot> leaving;
  std::uint64_t evaluated_after{0};  ///< commits
  bool has_spheres{false};

  /// Takes a slot for a node, in no cell and without a spring. `after` as in SlotLists.
  SlotLists::Slot insert(std::size_t list, NodeIndex node, const Pair& pair,
                         SlotLists::Slot after = SlotLists::none);
  void remove(SlotLists::Slot slot);
  void activate(std::uint32_t k);
};

/// The touching nodes of all pairs, with their springs, from step to step. A node that begins to
/// touch takes a free slot of its chunk, and one that lets go gives its slot back: no other node
/// moves.
///
/// A step writes the springs `now()` of all nodes and reads the others, until commit() exchanges
/// both.
class PairLanes {
 public:
  static constexpr std::uint32_t new_pair = 0xFFFFFFFF;

  /// Lists the pairs anew. `old_pairs` says for each where it was before, or new_pair. The first
  /// `interior` pairs and the others are in different chunks.
  void rebuild(std::span<const Pair> pairs, std::size_t interior,
               std::span<const std::uint32_t> old_pairs);

  [[nodiscard]] std::size_t chunk_count() const { return chunks_.size(); }
  /// Chunks of the interior pairs: the first ones.
  [[nodiscard]] std::size_t interior_chunk_count() const { return interior_chunks_; }
  [[nodiscard]] LaneChunk& chunk(std::size_t c) { return chunks_[c]; }
  [[nodiscard]] LaneChunk& chunk_of(std::size_t pair) { return chunks_[chunk_index(pair)]; }
  [[nodiscard]] const LaneChunk& chunk_of(std::size_t pair) const {
    return chunks_[chunk_index(pair)];
  }

  /// Prepares a chunk for an evaluation.
  void begin(LaneChunk& chunk);
  [[nodiscard]] std::size_t now() const { return now_; }
  void commit() {
    now_ = 1 - now_;
    ++commits_;
  }

  /// As of the last commit: nodes of a first, each in node order.
  [[nodiscard]] std::vector<NodeSpring> springs(std::size_t pair) const;
  /// Gives springs to a pair that has no nodes.
  void adopt(const Pair& listed, std::size_t pair, std::span<const NodeSpring> springs);

  /// Memory held, besides the object.
  [[nodiscard]] std::size_t bytes() const;

 private:
  [[nodiscard]] std::size_t chunk_index(std::size_t pair) const {
    return pair < interior_ ? pair / pairs_per_chunk_
                            : interior_chunks_ + (pair - interior_) / pairs_per_chunk_;
  }
  void remove_leaving(LaneChunk& chunk) const;

  std::vector<LaneChunk> chunks_;
  std::size_t pairs_per_chunk_{1};
  std::size_t interior_{0};
  std::size_t interior_chunks_{0};
  std::size_t now_{0};
  std::uint64_t commits_{0};
};

}  // namespace reckon
