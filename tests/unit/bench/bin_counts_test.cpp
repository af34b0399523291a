// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "bin_counts.hpp"

#include <gtest/gtest.h>

#include "paper_tables.hpp"

namespace reckon::bench {
namespace {

GridCut cut_cube(double edge, int ranks) {
  return cut_grid(Region{{0, 0, 0}, {edge, edge, edge}}, ranks, paper::bin_size);
}

TEST(BinCounts, ThoseOfTheStrongScalingTableOfThePaper) {
  for (const paper::BinRow& row : paper::table_2) {
    const GridCut cut = cut_cube(paper::table_2_edge, row.ranks);
    EXPECT_EQ(cut.block_count(), row.ranks);
    EXPECT_EQ(count_bins(cut).most_owned, row.theoretical_bins) << row.ranks << " ranks";
    EXPECT_EQ(count_bins(cut).most_with_halo, row.actual_bins) << row.ranks << " ranks";
  }
}

TEST(BinCounts, ThoseOfTheWeakScalingTableOfThePaper) {
  for (const paper::WeakRow& row : paper::table_3) {
    const GridCut cut = cut_cube(row.edge, row.ranks);
    EXPECT_EQ(cut.block_count(), row.ranks);
    EXPECT_EQ(count_bins(cut).most_owned, row.theoretical_bins) << row.edge << " long";
    EXPECT_EQ(count_bins(cut).most_with_halo, row.actual_bins) << row.edge << " long";
  }
}

TEST(BinCounts, TakeTheLargestOfUnequalBlocks) {
  GridCut cut;
  cut.bins = {5, 1, 1};
  cut.blocks = {2, 1, 1};  // of two and three bins, each with one layer of halo
  EXPECT_EQ(count_bins(cut).most_owned, 3);
  EXPECT_EQ(count_bins(cut).most_with_halo, 4);
}

}  // namespace
}  // namespace reckon::bench
