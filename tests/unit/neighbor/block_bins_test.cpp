// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/neighbor/block_bins.hpp"

#include <gtest/gtest.h>

#include <random>

#include "reckon/core/peak_memory.hpp"

namespace reckon {
namespace {

/// A cloud and one grain that is far off: most bins of the box around them are empty.
TEST(BlockBins, AFarGrainCostsNoMemoryAndChangesNoPair) {
  constexpr double reach = 2.3;
  for (const double far : {30.0, 3e3, 1e6, 1e12}) {
    std::mt19937_64 random{5};
    std::uniform_real_distribution<double> place{-6, 6};
    std::vector<GrainId> ids;
    std::vector<Vec3> positions;
    std::vector<double> radii;
    for (std::uint32_t n = 0; n < 300; ++n) {
      ids.emplace_back(n);
      positions.push_back({place(random), place(random), place(random)});
      radii.push_back(1);
    }
    positions.back() = {far, -far, far};
    const auto expected = find_pairs_brute_force(ids, positions, radii, 0.3, ids.size());
    const std::uint64_t before = peak_memory();
    const GridCut cut = cut_grid(bounding_region(positions), 1, reach);
    const BlockBins bins{cut, 0, positions, positions.size()};
    const auto by_grain = bins.pairs_by_grain(ids, positions, radii, 0.3);
    const auto by_bin = bins.pairs_by_bin(ids, positions, radii, 0.3);
    EXPECT_LT(peak_memory() - before, 10'000'000U) << far;
    ASSERT_GT(expected.size(), 100U);
    for (const auto* found : {&by_grain, &by_bin}) {
      ASSERT_EQ(found->size(), expected.size()) << far;
      for (std::size_t p = 0; p < expected.size(); ++p) {
        EXPECT_EQ((*found)[p].id_a, expected[p].id_a);
        EXPECT_EQ((*found)[p].id_b, expected[p].id_b);
      }
    }
  }
}

}  // namespace
}  // namespace reckon
