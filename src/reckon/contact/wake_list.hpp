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

/// Nodes that are near something, and when each must be looked at again.
///
/// Time is measured in motion: the odometer is what both sides have travelled together
/// (MotionMeter). A node whose clearance was d when the odometer stood at m cannot touch before it
/// stands at m + d: that is the node's wake-up. Nodes that are not in the list are all farther than
/// `rest`, so the list as a whole is complete until the odometer passes m + rest.
///
///       phi                                  list        wakes at
///        |   . . . . . . . . rest . . .      node  17    m + 0.020
///        |      o      o                     node  18    always: it touches
///   -----+--------x------x--------------     node  19    always: it touches
///        |           x                       node  23    m + 0.011
///
/// All of it is one block of memory. A step on a resting contact reads its front and no more:
///
///   | marks, Partner | Reference | touching nodes by index | other nodes by index | wake-ups |
///
/// Partner: what a test needs of the other side. Reference: how both lay when the list was made.
/// Node: what a test needs of a node; it has the field `NodeIndex node`. Wake-ups stand apart from
/// their nodes, since most are looked at without them.
template <class Partner, class Reference, class Node>
class WakeList {
  static_assert(std::is_trivially_copyable_v<Partner> && std::is_trivially_copyable_v<Reference> &&
                std::is_trivially_copyable_v<Node>);

 public:
  [[nodiscard]] bool exists() const { return block_ != nullptr; }
  [[nodiscard]] const Partner& partner() const { return block_->partner; }
  [[nodiscard]] const Reference& reference() const { return block_->reference; }
  /// Clearance of all nodes that are not listed, when the list was made [m].
  [[nodiscard]] double rest() const { return block_->rest; }

  [[nodiscard]] bool complete_at(double odometer) const {
    return block_ && odometer < block_->complete_until;
  }
  void set_complete_until(double odometer) { block_->complete_until = odometer; }

  /// Starts the list anew with room for `count` nodes, which set_node must then fill in node order.
  void restart(const Partner& partner, const Reference& reference, double odometer, double rest,
               std::size_t count) {
    reserve(static_cast<std::uint32_t>(count));
    block_->complete_until = odometer + rest;
    block_->next_wake = odometer;
    block_->rest = rest;
    block_->touching = 0;
    block_->count = static_cast<std::uint32_t>(count);
    block_->partner = partner;
    block_->reference = reference;
  }
  void set_node(std::size_t n, const Node& node, double wake) {
    nodes()[n] = node;
    wakes()[n] = wake;
  }

  /// Calls test(node) for every node that may touch. It returns the node's wake-up, or, if the node
  /// touches, wake_always after appending to `touches`. Touches end up in node order.
  /// Returns the odometer reading before which no node of the list can touch.
  template <class Test>
  double look(double odometer, std::vector<Touch>& touches, Test&& test) {
    Head& head = *block_;
    Node* const node = nodes();
    bool changed = false;
    for (std::uint32_t n = 0; n < head.touching; ++n) {
      const double wake = test(node[n]);
      if (wake == wake_always) continue;
      wakes()[n] = wake;
      changed = true;
    }
    if (!(odometer < head.next_wake)) {
      double* const wake = wakes();
      head.next_wake = wake_never;
      for (std::uint32_t n = head.touching; n < head.count; ++n) {
        if (!(odometer < wake[n])) {
          wake[n] = test(node[n]);
          changed |= wake[n] == wake_always;
        }
        head.next_wake = std::min(head.next_wake, wake[n]);
      }
    }
    if (changed) regroup(touches);
    return head.touching > 0 ? wake_always : std::min(head.next_wake, head.complete_until);
  }

  /// Memory held.
  [[nodiscard]] std::size_t bytes() const { return block_ ? bytes_for(block_->capacity) : 0; }

  /// Asks the memory for the wake-ups if a look at this reading will read them. Reads the head.
  void prefetch_wakes(double odometer) const {
    if (block_ && !(odometer < block_->next_wake)) __builtin_prefetch(wakes());
  }
  /// Asks the memory for what the next look reads first.
  void prefetch() const {
    constexpr std::size_t nodes_ahead = 2;
    const auto ask = [](const void* from, std::size_t bytes) {
      for (std::size_t b = 0; b < bytes; b += 64) {
        __builtin_prefetch(static_cast<const std::byte*>(from) + b);
      }
    };
    if (!block_) return;
    ask(block_.get(), offsetof(Head, reference));
    ask(block_.get() + 1, nodes_ahead * sizeof(Node));
  }

 private:
  struct alignas(64) Head {
    double complete_until;   // odometer reading
    double next_wake;        // the earliest of the nodes that do not touch: odometer reading
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

  [[nodiscard]] static std::size_t bytes_for(std::size_t capacity) {
    return sizeof(Head) + capacity * (sizeof(Node) + sizeof(double));
  }

  [[nodiscard]] Node* nodes() const {
    return std::launder(reinterpret_cast<Node*>(block_.get() + 1));
  }

  [[nodiscard]] double* wakes() const {
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
    double* const wake = wakes();
    /// Where the node belongs among those of [first, last).
    const auto place = [&](const Node& moving, std::uint32_t first, std::uint32_t last) {
      while (first < last && node[first].node < moving.node) ++first;
      return first;
    };
    for (std::uint32_t n = 0; n < head.touching;) {
      if (wake[n] == wake_always) {
        ++n;
        continue;
      }
      const std::uint32_t to = place(node[n], head.touching, head.count);
      std::rotate(node + n, node + n + 1, node + to);
      std::rotate(wake + n, wake + n + 1, wake + to);
      --head.touching;
    }
    head.next_wake = wake_never;
    for (std::uint32_t n = head.touching; n < head.count; ++n) {
      if (wake[n] != wake_always) {
        head.next_wake = std::min(head.next_wake, wake[n]);
        continue;
      }
      const std::uint32_t to = place(node[n], 0, head.touching);
      std::rotate(node + to, node + n, node + n + 1);
      std::rotate(wake + to, wake + n, wake + n + 1);
      ++head.touching;
    }
    std::sort(touches.begin(), touches.end(),
              [](const Touch& a, const Touch& b) { return a.node < b.node; });
  }

  std::unique_ptr<Head, FreeBlock> block_;  // the head, then the nodes
};

}  // namespace reckon
