// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reckon/domain/regions.hpp"
#include "reckon/neighbor/pair_list.hpp"

namespace reckon {

/// The bins of one block with a padding layer around it, and the paper's four lists (section 4.4):
///
///   bins[b]             first grain in bin b: a hash table, since most bins of a box around a far
///                       grain are empty
///   bin_list[g]         the bin of grain g
///   grain_list[g]       the next grain in the bin of grain g
///   belongs_to_rank[g]  whether g lives inside the block or is a ghost in the padding
///
/// The -1 of the paper is `nothing` here. A grain that is not on the rank is not in the lists at
/// all, instead of being marked as belonging elsewhere.
class BlockBins {
 public:
  enum class Residence : std::uint8_t { inside, ghost };
  static constexpr std::uint32_t nothing = 0xFFFFFFFF;

  /// The first `owned` of `positions` are inside block `block` of `cut`, the others are ghosts.
  BlockBins(const GridCut& cut, int block, std::span<const Vec3> positions, std::size_t owned);

  /// Pairs with at least one grain inside, found by iterating over grains (paper, section 5.4).
  [[nodiscard]] std::vector<Pair> pairs_by_grain(std::span<const GrainId> ids,
                                                 std::span<const Vec3> positions,
                                                 std::span<const double> radii, double skin) const;
  /// The same by walking over all bins, empty ones too: the paper's naive algorithm. Where a far
  /// grain leaves most of the box empty, only bins with grains are visited.
  [[nodiscard]] std::vector<Pair> pairs_by_bin(std::span<const GrainId> ids,
                                               std::span<const Vec3> positions,
                                               std::span<const double> radii, double skin) const;

  [[nodiscard]] std::uint64_t bin_count() const { return size_[0] * size_[1] * size_[2]; }

 private:
  [[nodiscard]] std::uint64_t bin_at(std::uint64_t x, std::uint64_t y, std::uint64_t z) const;
  [[nodiscard]] std::size_t slot_of(std::uint64_t bin) const;
  template <class Visit>
  void visit_bin(std::uint64_t bin, Visit&& visit) const;
  template <class Visit>
  void visit_half_neighbors(std::uint32_t grain, Visit&& visit) const;
  /// Those with grains behind it in its bin, and in half of the bins around.
  void add_pairs_of(std::uint32_t grain, std::span<const GrainId> ids,
                    std::span<const Vec3> positions, std::span<const double> radii, double skin,
                    std::vector<Pair>& pairs) const;

  std::array<std::uint64_t, 3> size_{};    // bins along x, y, z, padding included
  int shift_{0};                           // 64 - log2(table size)
  std::vector<std::uint32_t> bins_;        // table slot -> first grain
  std::vector<std::uint64_t> bin_list_;    // grain -> its bin
  std::vector<std::uint32_t> grain_list_;  // grain -> next grain of the same table slot
  std::vector<Residence> belongs_to_rank_;
};

}  // namespace reckon
