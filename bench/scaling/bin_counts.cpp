// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "bin_counts.hpp"

#include <algorithm>

namespace reckon::bench {

BinCounts count_bins(const GridCut& cut) {
  BinCounts most;
  for (int block = 0; block < cut.block_count(); ++block) {
    const std::array<int, 3> place = cut.block_place(block);
    int owned = 1;
    int with_halo = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const int bins = cut.first_bin(axis, place[a] + 1) - cut.first_bin(axis, place[a]);
      const int layers = (place[a] > 0 ? 1 : 0) + (place[a] + 1 < cut.blocks[a] ? 1 : 0);
      owned *= bins;
      with_halo *= bins + layers;
    }
    most.most_owned = std::max(most.most_owned, owned);
    most.most_with_halo = std::max(most.most_with_halo, with_halo);
  }
  return most;
}

}  // namespace reckon::bench
