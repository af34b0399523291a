// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>
#include <vector>

#include "reckon/contact/near_skin.hpp"
#include "reckon/contact/touch.hpp"

namespace reckon {

/// A Verlet list of nodes: those that are near something, and when each must be checked again.
///
/// The clock is the path length: the sum of what both sides have moved (DisplacementBound). A node
/// whose clearance was d at the path length m cannot touch before the path length is m + d: that is
/// the node's next check. All nodes that are not in the list are farther away than `rest`, so the
/// list as a whole is complete until the path length passes m + rest.
///
///       phi                                  list        next check
///        |   . . . . . . . . rest . . .      node  17    m + 0.020
///        |      o      o                     node  18    always: it touches
///   -----+--------x------x--------------     node  19    always: it touches
///        |           x                       node  23    m + 0.011
///
/// All of it is one block of memory. A step on a resting contact reads its front and no more:
///
///   | marks, Partner | Reference | touching nodes by index | other nodes by index | next checks |
///
/// Partner: what a test needs of the other side. Reference: how both lay when the list was made.
/// Node: what a test needs of a node; it has the field `NodeIndex node`. The next checks stand
/// apart from the nodes, since most are read without them.
template <class Partner, class Reference, class Node>
class VerletNodeList {
  static_assert(std::is_trivially_copyable_v<Partner> && std::is_trivially_copyable_v<Reference> &&
                std::is_trivially_copyable_v<Node>);

 public:
  [[nodiscard]] bool exists() const { return block_ != nullptr; }
  [[nodiscard]] const Partner& partner() const { return block_->partner; }
  [[nodiscard]] const Reference& reference() const { return block_->reference; }
  /// Clearance of all nodes that are not listed, when the list was made [m].
  [[nodiscard]] double rest() const { return block_->rest; }

  [[nodiscard]] bool complete_at(double path_length) const {
    return block_ && path_length < block_->complete_until;
  }
  void set_complete_until(double path_length) { block_->complete_until = path_length; }

  /// Starts the list anew with room for `count` nodes, which set_node must then fill in node order.
  void restart(const Partner& partner, const Reference& reference, double path_length, double rest,
               std::size_t count) {
    reserve(static_cast<std::uint32_t>(count));
    block_->complete_until = path_length + rest;
    block_->earliest_check = path_length;
    block_->rest = rest;
    block_->touching = 0;
    block_->count = static_cast<std::uint32_t>(count);
    block_->partner = partner;
    block_->reference = reference;
  }
  void set_node(std::size_t n, const Node& node, double next_check) {
    nodes()[n] = node;
    next_checks()[n] = next_check;
  }

  /// Calls test(node) for every node that may touch. It returns the node's next check, or, if the
  /// node touches, check_always after appending to `touches`. Touches end up in node order. Returns
  /// the path length before which no node of the list can touch.
  template <class Test>
  double look(double path_length, std::vector<Touch>& touches, Test&& test) {
    Head& head = *block_;
    Node* const node = nodes();
    bool changed = false;
    for (std::uint32_t n = 0; n < head.touching; ++n) {
      const double next_check = test(node[n]);
      if (next_check == check_always) continue;
      next_checks()[n] = next_check;
      changed = true;
    }
    if (look_at_others(path_length, test) == check_always) changed = true;
    if (changed) regroup(touches);
    return head.touching > 0 ? check_always : std::min(head.earliest_check, head.complete_until);
  }

  /// The same only for the nodes that did not touch. Where nodes that touch are kept elsewhere this
  /// is the whole look: `test` then returns check_never for a node that touches, until take_back()
  /// gives it a next check again.
  template <class Test>
  double look_at_others(double path_length, Test&& test) {
    Head& head = *block_;
    if (!(path_length < head.earliest_check)) {
      Node* const node = nodes();
      double* const next_check = next_checks();
      head.earliest_check = check_never;
      for (std::uint32_t n = head.touching; n < head.count; ++n) {
        if (!(path_length < next_check[n])) next_check[n] = test(node[n]);
        head.earliest_check = std::min(head.earliest_check, next_check[n]);
      }
    }
    return std::min(head.earliest_check, head.complete_until);
  }
  /// Sets a node that is listed, and its next check.
  void take_back(const Node& node, double next_check) {
    if (!block_) return;
    Node* const first = nodes();
    Node* const at =
        std::lower_bound(first, first + block_->count, node.node,
                         [](const Node& n, NodeIndex index) { return n.node < index; });
    if (at == first + block_->count || at->node != node.node) return;
    *at = node;
    next_checks()[at - first] = next_check;
    block_->earliest_check = std::min(block_->earliest_check, next_check);
  }

  /// Memory held.
  [[nodiscard]] std::size_t bytes() const { return block_ ? bytes_for(block_->capacity) : 0; }

  /// Asks the memory for the next checks if a look at this path length will read them. Reads the
  /// head.
  void prefetch_next_checks(double path_length) const {
    if (!block_ || path_length < block_->earliest_check) return;
    const double* const first = next_checks();
    for (std::uint32_t n = 0; n < block_->count; n += 8) __builtin_prefetch(first + n);
  }
  /// Asks the memory for the head.
  void prefetch_head() const { ask(block_.get(), block_ ? sizeof(Head) : 0); }
  /// Asks the memory for what the next look reads first.
  void prefetch() const {
    constexpr std::size_t nodes_ahead = 2;
    if (!block_) return;
    ask(block_.get(), offsetof(Head, reference));
    ask(block_.get() + 1, nodes_ahead * sizeof(Node));
  }

 private:
  struct alignas(64) Head {
    double complete_until;   // path length [m]
    double earliest_check;   // of the nodes that do not touch: path length [m]
    double rest;             // [m]
    std::uint32_t touching;  // nodes at the front
    std::uint32_t count;
    std::uint32_t capacity;
    Partner partner;
    alignas(64) Reference reference;
  };
  struct FreeBlock {
    void operator()(Head* head) const { ::operator delete (head, std::align_val_t{alignof(Head)}); }
  };
  static_assert(alignof(Node) <= alignof(Head) && alignof(double) <= alignof(Node));

  static void ask(const void* from, std::size_t bytes) {
    for (std::size_t b = 0; b < bytes; b += 64) {
      __builtin_prefetch(static_cast<const std::byte*>(from) + b);
    }
  }

  [[nodiscard]] static std::size_t bytes_for(std::size_t capacity) {
    return sizeof(Head) + capacity * (sizeof(Node) + sizeof(double));
  }

  [[nodiscard]] Node* nodes() const {
    return std::launder(reinterpret_cast<Node*>(block_.get() + 1));
  }

  [[nodiscard]] double* next_checks() const {
    return std::launder(reinterpret_cast<double*>(nodes() + block_->capacity));
  }

  /// Makes room; what the block held is lost if it must grow.
  void reserve(std::uint32_t count) {
    if (block_ && block_->capacity >= count) return;
    const std::uint32_t capacity = (count + 3) / 4 * 4;
    void* const memory = ::operator new (bytes_for(capacity), std::align_val_t{alignof(Head)});
    block_.reset(new (memory) Head{});
    block_->capacity = capacity;
    Node* const first = reinterpret_cast<Node*>(block_.get() + 1);
    std::uninitialized_value_construct_n(first, capacity);
    std::uninitialized_value_construct_n(reinterpret_cast<double*>(first + capacity), capacity);
  }

  /// Touching nodes to the front; both groups, and the touches, in node order. Both groups were in
  /// order before the look: only the nodes that change sides move, and what lies in between.
  void regroup(std::vector<Touch>& touches) {
    Head& head = *block_;
    Node* const node = nodes();
    double* const next_check = next_checks();
    /// Where the node belongs among those of [first, last).
    const auto place = [&](const Node& moving, std::uint32_t first, std::uint32_t last) {
      while (first < last && node[first].node < moving.node) ++first;
      return first;
    };
    for (std::uint32_t n = 0; n < head.touching;) {
      if (next_check[n] == check_always) {
        ++n;
        continue;
      }
      const std::uint32_t to = place(node[n], head.touching, head.count);
      std::rotate(node + n, node + n + 1, node + to);
      std::rotate(next_check + n, next_check + n + 1, next_check + to);
      --head.touching;
    }
    head.earliest_check = check_never;
    for (std::uint32_t n = head.touching; n < head.count; ++n) {
      if (next_check[n] != check_always) {
        head.earliest_check = std::min(head.earliest_check, next_check[n]);
        continue;
      }
      const std::uint32_t to = place(node[n], 0, head.touching);
      std::rotate(node + to, node + n, node + n + 1);
      std::rotate(next_check + to, next_check + n, next_check + n + 1);
      ++head.touching;
    }
    std::sort(touches.begin(), touches.end(),
              [](const Touch& a, const Touch& b) { return a.node < b.node; });
  }

  std::unique_ptr<Head, FreeBlock> block_;  // the head, then the nodes
};

}  // namespace reckon
