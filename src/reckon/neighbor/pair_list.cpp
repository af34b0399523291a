// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/neighbor/pair_list.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

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

void add_if_images_near(std::vector<Pair>& pairs, std::span<const GrainId> ids,
                        std::span<const Vec3> positions, std::span<const double> radii, double skin,
                        const PeriodicCell& cell, std::uint32_t s, std::uint32_t t) {
  if (ids[t] < ids[s]) std::swap(s, t);  // all ranks use one direction of a pair
  const double reach = radii[s] + radii[t] + skin;
  if (!(squared_norm(cell.branch(positions[s], positions[t])) < reach * reach)) return;
  pairs.push_back({ids[s], ids[t], s, t});
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
                                         std::size_t owned, const PeriodicCell* cell) {
  std::vector<Pair> pairs;
  for (std::uint32_t s = 0; s < owned; ++s) {
    for (std::uint32_t t = s + 1; t < ids.size(); ++t) {
      if (cell == nullptr) {
        add_if_near(pairs, ids, positions, radii, skin, s, t);
      } else {
        add_if_images_near(pairs, ids, positions, radii, skin, *cell, s, t);
      }
    }
  }
  sort_by_ids(pairs);
  return pairs;
}

namespace {

/// Grains in their cell, and copies of those within `reach` of a lower face, one edge on: two
/// grains that meet across a face are near each other among these.
struct Images {
  std::vector<Vec3> positions;
  std::vector<double> radii;
  std::vector<std::uint32_t> slots;

  Images(std::span<const Vec3> grains, std::span<const double> grain_radii,
         const PeriodicCell& cell, double reach) {
    const Vec3 widths = cell.widths();
    for (std::uint32_t slot = 0; slot < grains.size(); ++slot) {
      const Vec3 s = cell.fractions(grains[slot]);
      Vec3 home;  // edges to go back by
      Vec3 last;  // copies along each edge
      for (int axis = 0; axis < 3; ++axis) {
        if (!cell.is_periodic(axis)) continue;
        home[axis] = std::floor(s[axis]);
        if ((s[axis] - home[axis]) * widths[axis] <= reach) last[axis] = 1;
      }
      for (int n = 0; n < 8; ++n) {
        const Vec3 on{static_cast<double>(n & 1), static_cast<double>(n >> 1 & 1),
                      static_cast<double>(n >> 2)};
        if (on.x > last.x || on.y > last.y || on.z > last.z) continue;
        positions.push_back(grains[slot] + cell.shift_of(on - home));
        radii.push_back(grain_radii[slot]);
        slots.push_back(slot);
      }
    }
  }
};

}  // namespace

std::vector<Pair> find_pairs_in_cell(std::span<const GrainId> ids, std::span<const Vec3> positions,
                                     std::span<const double> radii, double skin, std::size_t owned,
                                     const PeriodicCell& cell) {
  if (ids.empty()) return {};
  constexpr double rounding = 1 + 1e-9;
  const double reach = (2 * *std::max_element(radii.begin(), radii.end()) + skin) * rounding;
  const Images images{positions, radii, cell, reach};
  const LinkedBins bins{images.positions, images.radii, skin};
  std::vector<std::vector<Pair>> found(static_cast<std::size_t>(thread_count()));
  parallel_for(images.slots.size(), 64, [&](std::size_t n) {
    const std::uint32_t grain = images.slots[n];
    auto& mine = found[static_cast<std::size_t>(thread_index())];
    bins.for_each_partner(static_cast<std::uint32_t>(n), [&](std::uint32_t m) {
      const std::uint32_t other = images.slots[m];
      if (other == grain || (grain >= owned && other >= owned)) return;
      add_if_images_near(mine, ids, positions, radii, skin, cell, grain, other);
    });
  });
  std::vector<Pair> pairs;
  for (const auto& part : found) pairs.insert(pairs.end(), part.begin(), part.end());
  sort_by_ids(pairs);
  const auto same = [](const Pair& p, const Pair& q) {
    return p.id_a == q.id_a && p.id_b == q.id_b;
  };
  pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
  return pairs;
}

void visit_pairs(std::span<const Vec3> positions, std::span<const double> radii,
                 const PeriodicCell* cell,
                 const std::function<bool(std::uint32_t, std::uint32_t)>& visit) {
  if (positions.empty()) return;
  constexpr double rounding = 1 + 1e-9;
  const double reach = 2 * *std::max_element(radii.begin(), radii.end()) * rounding;
  std::optional<Images> images;
  if (cell != nullptr) images.emplace(positions, radii, *cell, reach);
  const std::span<const Vec3> places =
      images ? std::span{std::as_const(images->positions)} : positions;
  const std::span<const double> sizes = images ? std::span{std::as_const(images->radii)} : radii;
  const LinkedBins bins{places, sizes, 0};
  const auto slot_of = [&](std::uint32_t n) { return images ? images->slots[n] : n; };
  const auto count = static_cast<std::uint32_t>(places.size());
  bool more = true;
  for (std::uint32_t n = 0; n < count && more; ++n) {
    bins.for_each_partner(n, [&](std::uint32_t m) {
      const std::uint32_t s = slot_of(n);
      const std::uint32_t t = slot_of(m);
      if (!more || s == t) return;
      const Vec3 apart =
          cell != nullptr ? cell->branch(positions[s], positions[t]) : positions[s] - positions[t];
      const double meeting = radii[s] + radii[t];
      if (squared_norm(apart) < meeting * meeting) more = visit(s, t);
    });
  }
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
