// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "reckon/core/id.hpp"
#include "reckon/grains/periodic_cell.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon {

/// Two grains that might touch before the next list.
struct Pair {
  GrainId id_a;          ///< the lower id
  GrainId id_b;          ///< the higher id
  std::uint32_t slot_a;  ///< place of `id_a` in this process
  std::uint32_t slot_b;
};

/// All pairs whose bounding spheres come within `skin` of each other, sorted by (id_a, id_b).
/// `ids`, `positions` and `radii` are per slot; found with LinkedBins in the time of one pass.
/// Slots from `owned` on are ghosts: pairs of two ghosts are left out.
[[nodiscard]] std::vector<Pair> find_pairs(std::span<const GrainId> ids,
                                           std::span<const Vec3> positions,
                                           std::span<const double> radii, double skin,
                                           std::size_t owned);

/// The same by testing every grain against every other: the oracle. With a cell, as below.
[[nodiscard]] std::vector<Pair> find_pairs_brute_force(std::span<const GrainId> ids,
                                                       std::span<const Vec3> positions,
                                                       std::span<const double> radii, double skin,
                                                       std::size_t owned,
                                                       const PeriodicCell* cell = nullptr);

/// The same between nearest images: LinkedBins of the grains in the cell, with copies of those near
/// its lower faces behind its upper faces. The cell must be twice as wide as any pair reaches.
[[nodiscard]] std::vector<Pair> find_pairs_in_cell(std::span<const GrainId> ids,
                                                   std::span<const Vec3> positions,
                                                   std::span<const double> radii, double skin,
                                                   std::size_t owned, const PeriodicCell& cell);

/// Visits, one by one and without listing them, the slots of pairs whose bounding spheres meet,
/// until `visit` returns false: memory is proportional to the grains, for any number in one place.
/// With a cell, between nearest images, and a pair may come more than once.
void visit_pairs(std::span<const Vec3> positions, std::span<const double> radii,
                 const PeriodicCell* cell,
                 const std::function<bool(std::uint32_t, std::uint32_t)>& visit);

/// Appends the pair of slots `s` and `t` when their spheres come within `skin` of each other.
void add_if_near(std::vector<Pair>& pairs, std::span<const GrainId> ids,
                 std::span<const Vec3> positions, std::span<const double> radii, double skin,
                 std::uint32_t s, std::uint32_t t);
/// The same for their nearest images.
void add_if_images_near(std::vector<Pair>& pairs, std::span<const GrainId> ids,
                        std::span<const Vec3> positions, std::span<const double> radii, double skin,
                        const PeriodicCell& cell, std::uint32_t s, std::uint32_t t);
/// The order of every list of pairs: by id_a, then id_b.
void sort_by_ids(std::vector<Pair>& pairs);

/// For every grain, the pairs that it is part of, in the order of the partners' ids: the order in
/// which its forces are summed.
struct PairsOfGrain {
  struct Entry {
    std::uint32_t pair;
    bool is_a;  ///< whether the grain is the pair's `a`
  };
  std::vector<std::uint32_t> first;  ///< per slot, and one past the end
  std::vector<Entry> entries;

  [[nodiscard]] std::span<const Entry> of(std::size_t slot) const {
    return std::span{entries}.subspan(first[slot], first[slot + 1] - first[slot]);
  }
};

/// `by_ids` lists the pairs as sort_by_ids orders them; `slot_count` grains.
[[nodiscard]] PairsOfGrain index_pairs(std::span<const Pair> pairs,
                                       std::span<const std::uint32_t> by_ids,
                                       std::size_t slot_count);

}  // namespace reckon
