// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/neighbor/pair_list.hpp"

#include <algorithm>

#include "reckon/neighbor/linked_bins.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {

void add_if_near(std::vector<Pair>& pairs, std::span<const GrainId> ids,
                 std::span<const Vec3> positions, std::span<const double> radii, double skin,
                 std::uint32_t s, std::uint32_t t) {
  const double reach = radii[s] + radii[t] + skin;
  if (!(squared_norm(positions[s] - positions[t]) < reach * reach)) return;
  pairs.push_back(ids[s] < ids[t] ? Pair{ids[s], ids[t], s, t} : Pair{ids[t], ids[s], t, s});
}

void sort_by_ids(std::vector<Pair>& pairs) {
  std::sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) {
    return p.id_a != q.id_a ? p.id_a < q.id_a : p.id_b < q.id_b;
  });
}

std::vector<Pair> find_pairs(std::span<const GrainId> ids, std::span<const Vec3> positions,
                             std::span<const double> radii, double skin, std::size_t owned) {
  if (ids.empty()) return {};
  const LinkedBins bins{positions, radii, skin};
  std::vector<std::vector<Pair>> found(static_cast<std::size_t>(thread_count()));
  parallel_for(ids.size(), 64, [&](std::size_t slot) {
    const auto grain = static_cast<std::uint32_t>(slot);
    auto& mine = found[static_cast<std::size_t>(thread_index())];
    bins.for_each_partner(grain, [&](std::uint32_t other) {
      if (grain >= owned && other >= owned) return;
      add_if_near(mine, ids, positions, radii, skin, grain, other);
    });
  });
  std::vector<Pair> pairs;
  for (const auto& part : found) pairs.insert(pairs.end(), part.begin(), part.end());
  sort_by_ids(pairs);
  return pairs;
}

std::vector<Pair> find_pairs_brute_force(std::span<const GrainId> ids,
                                         std::span<const Vec3> positions,
                                         std::span<const double> radii, double skin,
                                         std::size_t owned) {
  std::vector<Pair> pairs;
  for (std::uint32_t s = 0; s < owned; ++s) {
    for (std::uint32_t t = s + 1; t < ids.size(); ++t) {
      add_if_near(pairs, ids, positions, radii, skin, s, t);
    }
  }
  sort_by_ids(pairs);
  return pairs;
}

PairsOfGrain index_pairs(std::span<const Pair> pairs, std::span<const std::uint32_t> by_ids,
                         std::size_t slot_count) {
  PairsOfGrain index;
  index.first.assign(slot_count + 1, 0);
  for (const Pair& pair : pairs) {
    ++index.first[pair.slot_a + 1];
    ++index.first[pair.slot_b + 1];
  }
  for (std::size_t slot = 0; slot < slot_count; ++slot) index.first[slot + 1] += index.first[slot];
  index.entries.resize(2 * pairs.size());
  std::vector<std::uint32_t> cursor(index.first.begin(), index.first.end() - 1);
  // A grain's partners of lower id are those of the pairs in which it is `b`: they come first.
  for (const std::uint32_t p : by_ids) {
    index.entries[cursor[pairs[p].slot_b]++] = {p, false};
  }
  for (const std::uint32_t p : by_ids) {
    index.entries[cursor[pairs[p].slot_a]++] = {p, true};
  }
  return index;
}

}  // namespace reckon
