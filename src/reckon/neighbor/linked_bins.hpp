// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// Linked-list binning (paper, sections 2.2 and 4) in layers (a hierarchical grid, Ogarko & Luding
/// 2012). Layer 0 cuts space into cubic bins that hold the reach of the largest grains, layer 1
/// into bins half as wide, and so on. A grain belongs to the finest layer whose bins are at least
/// as wide as twice its radius plus the skin. The grain of the finer layer finds the pair:
///
///   layer 0  |         O          |                    |    a large grain's bin
///   layer 1  |         |          |         |          |    (empty)
///   layer 2  |  o |    |  o  | o  |    |    | o   |    |    small grains search their own
///            `-- half of 26 neighbours ---'                 layer, then in 27 bins of each coarser
///
/// Grains of a bin form a chain: `first` of the bin, then `next` of each grain. Bins are stored in
/// a hash table as large as the number of grains, not in a box: the domain has no bounds, empty
/// space costs nothing, and memory does not grow when a grain flies away.
class LinkedBins {
 public:
  /// `skin` widens the reach of every pair [m]; positions and radii are per grain.
  LinkedBins(std::span<const Vec3> positions, std::span<const double> radii, double skin);

  /// Calls visit(partner) for grains near `grain` so that over all grains each pair whose spheres
  /// come within the skin is visited exactly once (others may be visited too).
  template <class Visit>
  void for_each_partner(std::uint32_t grain, Visit&& visit) const {
    const Bin home = bin_[grain];
    for (std::uint32_t other = next_[grain]; other != end_of_chain; other = next_[other]) {
      if (bin_[other] == home) visit(other);
    }
    for (const auto& step : half_stencil) {
      visit_bin({home.x + step[0], home.y + step[1], home.z + step[2], home.layer}, visit);
    }
    for (int layer = home.layer - 1; layer >= 0; --layer) {
      if (!layer_is_used_[static_cast<std::size_t>(layer)]) continue;
      const Bin around = bin_in_layer(grain, layer);
      for (int n = 0; n < 27; ++n) {
        visit_bin({around.x + n % 3 - 1, around.y + n / 3 % 3 - 1, around.z + n / 9 - 1, layer},
                  visit);
      }
    }
  }

 private:
  struct Bin {
    std::int64_t x, y, z;
    int layer;
    friend bool operator==(const Bin&, const Bin&) = default;
  };
  static constexpr std::uint32_t end_of_chain = std::numeric_limits<std::uint32_t>::max();
  /// One of each pair of opposite neighbours.
  static constexpr int half_stencil[13][3] = {
      {1, 0, 0},  {-1, 1, 0}, {0, 1, 0}, {1, 1, 0},  {-1, -1, 1}, {0, -1, 1}, {1, -1, 1},
      {-1, 0, 1}, {0, 0, 1},  {1, 0, 1}, {-1, 1, 1}, {0, 1, 1},   {1, 1, 1}};

  template <class Visit>
  void visit_bin(const Bin& bin, Visit&& visit) const {
    for (std::uint32_t other = first_[slot_of(bin)]; other != end_of_chain; other = next_[other]) {
      if (bin_[other] == bin) visit(other);
    }
  }
  [[nodiscard]] Bin bin_in_layer(std::uint32_t grain, int layer) const;

  [[nodiscard]] std::size_t slot_of(const Bin& bin) const {
    const auto hash = static_cast<std::uint64_t>(bin.x) * 0x9E3779B97F4A7C15U ^
                      static_cast<std::uint64_t>(bin.y) * 0xC2B2AE3D27D4EB4FU ^
                      static_cast<std::uint64_t>(bin.z) * 0x165667B19E3779F9U ^
                      static_cast<std::uint64_t>(bin.layer) * 0xD6E8FEB86659FD93U;
    return static_cast<std::size_t>(hash >> shift_);
  }

  std::span<const Vec3> positions_;
  double widest_{0};                  // bin of layer 0 [m]
  std::vector<bool> layer_is_used_;   // by some grain
  int shift_{0};                      // 64 - log2(table size)
  std::vector<Bin> bin_;              // grain -> its bin
  std::vector<std::uint32_t> next_;   // grain -> next grain of the same table slot
  std::vector<std::uint32_t> first_;  // table slot -> first grain
};

}  // namespace reckon
