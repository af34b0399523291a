// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/domain/regions.hpp"

namespace reckon::bench {

/// The bins that a rank works on, as the paper's Tables 2 and 3 count them.
struct BinCounts {
  int most_owned{0};  ///< of the largest block ("theoretical" where blocks are equal)
  int most_with_halo{
      0};  ///< of the block with most, its halo from existing neighbours included ("actual")
};

[[nodiscard]] BinCounts count_bins(const GridCut& cut);

}  // namespace reckon::bench
