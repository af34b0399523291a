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
///   bins[b]             first grain in bin b
///   bin_list[g]         the bin of grain g
///   grain_list[g]       the next grain in the bin of grain g
///   belongs_to_rank[g]  whether g lives inside the block or is a ghost in the padding
///
/// Where the paper writes -1, `nothing` stands here. A grain that its rank does not know is not in
/// the lists at all, instead of being marked as belonging elsewhere.
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
  /// The same by walking over all bins, empty ones too: the paper's naive algorithm.
  [[nodiscard]] std::vector<Pair> pairs_by_bin(std::span<const GrainId> ids,
                                               std::span<const Vec3> positions,
                                               std::span<const double> radii, double skin) const;

  [[nodiscard]] std::size_t bin_count() const { return bins_.size(); }

 private:
  [[nodiscard]] std::uint32_t bin_at(int x, int y, int z) const;
  template <class Visit>
  void visit_half_neighbors(std::uint32_t grain, Visit&& visit) const;
  /// Those with grains behind it in its bin, and in half of the bins around.
  void add_pairs_of(std::uint32_t grain, std::span<const GrainId> ids,
                    std::span<const Vec3> positions, std::span<const double> radii, double skin,
                    std::vector<Pair>& pairs) const;

  std::array<int, 3> size_{};  // bins along x, y, z, padding included
  std::vector<std::uint32_t> bins_;
  std::vector<std::uint32_t> bin_list_;
  std::vector<std::uint32_t> grain_list_;
  std::vector<Residence> belongs_to_rank_;
};

}  // namespace reckon
