// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/slot_lists.hpp"

namespace reckon {

SlotLists::Slot SlotLists::find(std::size_t list, std::uint32_t key) const {
  Slot slot = first_[list];
  while (slot != none && entries_[slot].key < key) slot = entries_[slot].next;
  return slot != none && entries_[slot].key == key ? slot : none;
}

SlotLists::Slot SlotLists::insert(std::size_t list, std::uint32_t key, Slot after) {
  if (first_free_ == none) add_block();
  const Slot slot = first_free_;
  first_free_ = entries_[slot].next;
  Slot* link = after == none ? &first_[list] : &entries_[after].next;
  while (*link != none && entries_[*link].key < key) link = &entries_[*link].next;
  entries_[slot] = {*link, key};
  *link = slot;
  used_[slot / block] = static_cast<std::uint8_t>(used_[slot / block] | (1U << slot % block));
  ++size_;
  return slot;
}

void SlotLists::remove(std::size_t list, Slot slot) {
  Slot* link = &first_[list];
  while (*link != slot) link = &entries_[*link].next;
  *link = entries_[slot].next;
  entries_[slot].next = first_free_;
  first_free_ = slot;
  used_[slot / block] = static_cast<std::uint8_t>(used_[slot / block] & ~(1U << slot % block));
  --size_;
}

void SlotLists::add_block() {
  const auto begin = static_cast<Slot>(entries_.size());
  for (Slot slot = begin; slot < begin + block; ++slot) {
    entries_.push_back({slot + 1 < begin + block ? slot + 1 : none, 0});
  }
  first_free_ = begin;
  used_.push_back(0);
}

}  // namespace reckon
