// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// Linked-list binning (paper, sections 2.2 and 4). Space is cut into cubic bins at least as large
/// as the largest reach of a pair, so partners lie in the same bin or in one of its 26 neighbours.
/// Grains of a bin form a chain: `first` of the bin, then `next` of each grain.
///
/// Bins live in a hash table as large as the number of grains, not in a box: there is no domain to
/// leave, an empty space costs nothing, and memory does not grow with a grain that flies away.
class LinkedBins {
 public:
  /// `reach` bounds the distance of the centres of any pair that is to be found [m]; > 0.
  LinkedBins(std::span<const Vec3> positions, double reach);

  /// Calls visit(partner) for every grain that shares the bin of `grain` and comes after it in the
  /// chain, or lies in one of 13 of the 26 neighbouring bins: over all grains, each pair of
  /// neighbours is visited exactly once.
  template <class Visit>
  void for_each_half_neighbor(std::uint32_t grain, Visit&& visit) const {
    const Bin home = bin_[grain];
    for (std::uint32_t other = next_[grain]; other != end_of_chain; other = next_[other]) {
      if (bin_[other] == home) visit(other);
    }
    for (const auto& step : half_stencil) {
      const Bin bin{home.x + step[0], home.y + step[1], home.z + step[2]};
      for (std::uint32_t other = first_[slot_of(bin)]; other != end_of_chain;
           other = next_[other]) {
        if (bin_[other] == bin) visit(other);
      }
    }
  }

 private:
  struct Bin {
    std::int64_t x, y, z;
    friend bool operator==(const Bin&, const Bin&) = default;
  };
  static constexpr std::uint32_t end_of_chain = std::numeric_limits<std::uint32_t>::max();
  /// One of each pair of opposite neighbours.
  static constexpr int half_stencil[13][3] = {
      {1, 0, 0},  {-1, 1, 0}, {0, 1, 0}, {1, 1, 0},  {-1, -1, 1}, {0, -1, 1}, {1, -1, 1},
      {-1, 0, 1}, {0, 0, 1},  {1, 0, 1}, {-1, 1, 1}, {0, 1, 1},   {1, 1, 1}};

  [[nodiscard]] std::size_t slot_of(const Bin& bin) const {
    const auto hash = static_cast<std::uint64_t>(bin.x) * 0x9E3779B97F4A7C15U ^
                      static_cast<std::uint64_t>(bin.y) * 0xC2B2AE3D27D4EB4FU ^
                      static_cast<std::uint64_t>(bin.z) * 0x165667B19E3779F9U;
    return static_cast<std::size_t>(hash >> shift_);
  }

  int shift_{0};                      // 64 - log2(table size)
  std::vector<Bin> bin_;              // grain -> its bin
  std::vector<std::uint32_t> next_;   // grain -> next grain of the same table slot
  std::vector<std::uint32_t> first_;  // table slot -> first grain
};

}  // namespace reckon
