// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reckon/neighbor/pair_list.hpp"

namespace reckon {

/// What each of the first `owned` grains costs its rank: itself, half of every pair with another of
/// them, and all of a pair with a ghost, which no other grain of this rank shares. Their sum is the
/// number of grains and pairs that the rank works on. A count, not a time, so that a run shares out
/// its grains alike each time.
[[nodiscard]] inline std::vector<double> grain_costs(std::span<const Pair> pairs,
                                                     std::size_t owned) {
  std::vector<double> costs(owned, 1.0);
  for (const Pair& pair : pairs) {
    const double share = pair.slot_a < owned && pair.slot_b < owned ? 0.5 : 1.0;
    if (pair.slot_a < owned) costs[pair.slot_a] += share;
    if (pair.slot_b < owned) costs[pair.slot_b] += share;
  }
  return costs;
}

}  // namespace reckon
