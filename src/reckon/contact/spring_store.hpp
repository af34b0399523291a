// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reckon/contact/coulomb.hpp"
#include "reckon/core/id.hpp"
#include "reckon/math/vec3.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {

/// The memory of one touching node: it lives only while the node keeps touching the same partner.
struct NodeSpring {
  NodeIndex node{0};          ///< of the master
  bool master_is_b{false};    ///< in a pair of grains: which of the two the node belongs to
  Vec3 shear_force;           ///< on the master, world frame [N]
  Vec3 normal;                ///< unit, out of the slave, world frame
  double dashpot_push{0};     ///< along the normal [N]
  double shear_stiffness{0};  ///< under the law of its step [N/m]

  [[nodiscard]] ShearSpring spring() const { return {shear_force, shear_stiffness}; }
  friend bool operator==(const NodeSpring&, const NodeSpring&) = default;
};

/// Where a pair's springs lie in a SpringStore.
struct SpringRange {
  std::uint32_t thread{0};
  std::uint32_t first{0};
  std::uint32_t count{0};
};

/// Springs of all pairs, written anew at every step. Only touching nodes are stored. Each thread
/// appends to an arena of its own, and the arenas of the last step are read meanwhile:
///
///   step n     read  [thread 0: .......][thread 1: ....]     written during step n-1
///              write [thread 0: ....][thread 1: .......]     read during step n+1
///
/// Where a spring lies depends on scheduling; what it holds does not.
class SpringStore {
 public:
  [[nodiscard]] std::span<const NodeSpring> read(const SpringRange& range) const {
    if (range.count == 0) return {};
    return std::span{read_[range.thread].springs}.subspan(range.first, range.count);
  }

  /// Prepares for one step's writing by up to `threads` threads.
  void begin_writing(int threads) {
    if (write_.size() < static_cast<std::size_t>(threads)) {
      write_.resize(static_cast<std::size_t>(threads));
    }
    for (auto& arena : write_) arena.springs.clear();
  }
  /// Appends to the calling thread's arena; `write` pushes onto the vector it is given.
  template <class Write>
  [[nodiscard]] SpringRange append(Write&& write) {
    const int thread = thread_index();
    auto& arena = write_[static_cast<std::size_t>(thread)].springs;
    const std::size_t first = arena.size();
    write(arena);
    return {static_cast<std::uint32_t>(thread), static_cast<std::uint32_t>(first),
            static_cast<std::uint32_t>(arena.size() - first)};
  }
  /// Adds springs from elsewhere to those that are read.
  [[nodiscard]] SpringRange adopt(std::span<const NodeSpring> springs) {
    if (read_.empty()) read_.resize(1);
    auto& arena = read_.front().springs;
    const std::size_t first = arena.size();
    arena.insert(arena.end(), springs.begin(), springs.end());
    return {0, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(springs.size())};
  }
  /// Memory held, besides the object.
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto* arenas : {&read_, &write_}) {
      for (const Arena& arena : *arenas) sum += arena.springs.capacity() * sizeof(NodeSpring);
    }
    return sum;
  }

  /// What was written becomes what is read.
  void commit() { read_.swap(write_); }

 private:
  /// On a cache line of its own: threads append at the same time.
  struct alignas(64) Arena {
    std::vector<NodeSpring> springs;
  };
  std::vector<Arena> read_;
  std::vector<Arena> write_;
};

}  // namespace reckon
