// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace reckon {

/// Several short ordered lists over one array of slots. A member of a list takes any free slot and
/// keeps it until it is removed, so that what is stored per slot never moves:
///
///   list 0:  node 4 -> node 9            slot   0   1   2   3   4   5   6   7
///   list 1:  node 2                      node   9   -   4   2   -   -   -   -
///
/// Slots come in blocks of eight.
class SlotLists {
 public:
  using Slot = std::uint32_t;
  static constexpr Slot none = 0xFFFFFFFF;
  static constexpr std::uint32_t block = 8;

  explicit SlotLists(std::size_t lists = 0) : first_(lists, none) {}

  [[nodiscard]] std::size_t lists() const { return first_.size(); }
  /// The first member of a list, or none.
  [[nodiscard]] Slot first(std::size_t list) const { return first_[list]; }
  /// The next member of the same list, or none.
  [[nodiscard]] Slot next(Slot slot) const { return entries_[slot].next; }
  [[nodiscard]] std::uint32_t key(Slot slot) const { return entries_[slot].key; }
  /// The member with this key, or none.
  [[nodiscard]] Slot find(std::size_t list, std::uint32_t key) const;

  /// Adds a member where its key belongs. The list must not have the key. `after` may be any member
  /// with a lower key, from which the place is searched.
  Slot insert(std::size_t list, std::uint32_t key, Slot after = none);
  void remove(std::size_t list, Slot slot);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t blocks() const { return used_.size(); }
  /// Which slots of a block are members of a list: one bit each, the first slot's is bit 0.
  [[nodiscard]] std::uint32_t used(std::size_t b) const { return used_[b]; }
  /// Whether the members would fit in half of the blocks, with one to spare.
  [[nodiscard]] bool is_sparse() const {
    return 2 * ((size_ + block - 1) / block + 1) <= used_.size();
  }

  /// Memory held, besides the object.
  [[nodiscard]] std::size_t bytes() const {
    return first_.capacity() * sizeof(Slot) + entries_.capacity() * sizeof(Entry) +
           used_.capacity();
  }

 private:
  struct Entry {
    Slot next;  // in its list, or of the free slots
    std::uint32_t key;
  };

  void add_block();

  std::vector<Slot> first_;
  std::vector<Entry> entries_;
  std::vector<std::uint8_t> used_;
  Slot first_free_{none};
  std::size_t size_{0};
};

}  // namespace reckon
