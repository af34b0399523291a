// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/slot_lists.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "reckon/core/random.hpp"

namespace reckon {
namespace {

using Slot = SlotLists::Slot;

/// What SlotLists must hold, as plain maps from keys to slots.
using Model = std::vector<std::map<std::uint32_t, Slot>>;

void expect_same(const SlotLists& lists, const Model& model) {
  std::set<Slot> used;
  for (std::size_t list = 0; list < model.size(); ++list) {
    Slot slot = lists.first(list);
    for (const auto& [key, expected] : model[list]) {
      ASSERT_EQ(slot, expected);
      ASSERT_EQ(lists.key(slot), key);
      ASSERT_EQ(lists.find(list, key), slot);
      ASSERT_TRUE(used.insert(slot).second) << "a slot is in two lists";
      slot = lists.next(slot);
    }
    ASSERT_EQ(slot, SlotLists::none);
  }
  ASSERT_EQ(lists.size(), used.size());
  std::set<Slot> marked;
  for (std::size_t b = 0; b < lists.blocks(); ++b) {
    for (std::uint32_t bit = 0; bit < SlotLists::block; ++bit) {
      if ((lists.used(b) >> bit & 1) != 0) {
        marked.insert(static_cast<Slot>(b) * SlotLists::block + bit);
      }
    }
  }
  ASSERT_EQ(marked, used);
}

TEST(SlotLists, HoldWhatPlainMapsHold) {
  for (std::uint64_t walk = 0; walk < 20; ++walk) {
    RandomStream random{walk, RandomPurpose::other, 3};
    const auto below = [&](std::size_t n) {
      return static_cast<std::size_t>(random.uniform(0, static_cast<double>(n)));
    };
    SlotLists lists{5};
    Model model(5);
    for (int step = 0; step < 2000; ++step) {
      const std::size_t list = below(5);
      const auto key = static_cast<std::uint32_t>(below(40));
      const double share = step / 500 % 2 == 0 ? 0.8 : 0.2;  // grows and shrinks in turns
      const auto found = model[list].find(key);
      if (found == model[list].end()) {
        ASSERT_EQ(lists.find(list, key), SlotLists::none);
        if (random.uniform() > share) continue;
        const auto place = model[list].lower_bound(key);
        const bool with_hint = place != model[list].begin() && random.uniform() < 0.5;
        const Slot after = with_hint ? std::prev(place)->second : SlotLists::none;
        model[list][key] = lists.insert(list, key, after);
      } else if (random.uniform() > share) {
        lists.remove(list, found->second);
        model[list].erase(found);
      }
      expect_same(lists, model);
      if (HasFatalFailure()) FAIL() << "walk " << walk << " step " << step;
    }
  }
}

TEST(SlotLists, FreeSlotsAreUsedAgainAndOthersStay) {
  SlotLists lists{1};
  std::vector<Slot> slots;
  for (std::uint32_t key = 0; key < 16; ++key) slots.push_back(lists.insert(0, key));
  EXPECT_EQ(lists.blocks(), 2U);
  lists.remove(0, slots[3]);
  lists.remove(0, slots[9]);
  const Slot first = lists.insert(0, 100);
  const Slot second = lists.insert(0, 50);
  EXPECT_EQ(lists.blocks(), 2U);
  EXPECT_EQ((std::set{first, second}), (std::set{slots[3], slots[9]}));
  EXPECT_EQ(lists.find(0, 4), slots[4]);
}

TEST(SlotLists, AreSparseWhenHalfOfTheBlocksWouldDo) {
  SlotLists lists{1};
  for (std::uint32_t key = 0; key < 64; ++key) lists.insert(0, key);
  EXPECT_FALSE(lists.is_sparse());
  std::uint32_t key = 0;
  while (!lists.is_sparse()) {
    ASSERT_LT(key, 64U);
    lists.remove(0, lists.find(0, key++));
  }
  EXPECT_EQ(lists.size(), 24U);
  SlotLists few{1};
  few.insert(0, 1);
  EXPECT_FALSE(few.is_sparse());
}

}  // namespace
}  // namespace reckon
