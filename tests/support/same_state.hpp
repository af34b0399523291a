// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "reckon/simulation/simulation.hpp"

namespace reckon::testing {

/// Fails at the first difference in any bit of two states.
inline void expect_same_state(const SimulationState& a, const SimulationState& b) {
  EXPECT_EQ(a.step, b.step);
  ASSERT_EQ(a.grains.size(), b.grains.size());
  for (std::size_t g = 0; g < a.grains.size(); ++g) {
    ASSERT_EQ(a.grains[g], b.grains[g]) << "grain " << a.grains[g].id.get();
  }
  ASSERT_EQ(a.pair_springs.size(), b.pair_springs.size());
  for (std::size_t p = 0; p < a.pair_springs.size(); ++p) {
    ASSERT_EQ(a.pair_springs[p].id_a, b.pair_springs[p].id_a);
    ASSERT_EQ(a.pair_springs[p].id_b, b.pair_springs[p].id_b);
    ASSERT_EQ(a.pair_springs[p].springs, b.pair_springs[p].springs);
  }
  ASSERT_EQ(a.wall_springs.size(), b.wall_springs.size());
  for (std::size_t w = 0; w < a.wall_springs.size(); ++w) {
    ASSERT_EQ(a.wall_springs[w].grain, b.wall_springs[w].grain);
    ASSERT_EQ(a.wall_springs[w].wall, b.wall_springs[w].wall);
    ASSERT_EQ(a.wall_springs[w].springs, b.wall_springs[w].springs);
  }
}

}  // namespace reckon::testing
