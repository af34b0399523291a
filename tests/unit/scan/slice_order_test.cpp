// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/slice_order.hpp"

#include <gtest/gtest.h>

#include "../avatar/expect_error.hpp"

namespace reckon {
namespace {

using test::expect_error;
using Names = std::vector<std::string>;

Names ordered(const Names& names) {
  Names result;
  for (const auto& file : order_slices({names.begin(), names.end()}, "folder").files) {
    result.push_back(file.string());
  }
  return result;
}

TEST(SliceOrder, FollowsTheNumbersNotTheText) {
  EXPECT_EQ(ordered({"img1.tif", "img10.tif", "img2.tif", "img3.tif", "img4.tif", "img5.tif",
                     "img6.tif", "img7.tif", "img8.tif", "img9.tif"}),
            (Names{"img1.tif", "img2.tif", "img3.tif", "img4.tif", "img5.tif", "img6.tif",
                   "img7.tif", "img8.tif", "img9.tif", "img10.tif"}));
  EXPECT_EQ(ordered({"9.tif", "10.tif", "11.tif"}), (Names{"9.tif", "10.tif", "11.tif"}));
  EXPECT_EQ(ordered({"a3_x09.tif", "a3_x10.tif", "a3_x8.tif"}),
            (Names{"a3_x8.tif", "a3_x09.tif", "a3_x10.tif"}));
}

TEST(SliceOrder, SignsAndDecimalsAreNumbers) {
  EXPECT_EQ(ordered({"z-1.tif", "z-2.tif", "z0.tif", "z1.tif"}),
            (Names{"z-2.tif", "z-1.tif", "z0.tif", "z1.tif"}));
  EXPECT_EQ(ordered({"z_-1.tif", "z_-2.tif", "z_-3.tif"}),
            (Names{"z_-3.tif", "z_-2.tif", "z_-1.tif"}));
  EXPECT_EQ(ordered({"img-1.tif", "img-2.tif", "img-3.tif"}),
            (Names{"img-1.tif", "img-2.tif", "img-3.tif"}));
  EXPECT_EQ(ordered({"z10.0.tif", "z9.5.tif", "z9.0.tif", "z10.5.tif"}),
            (Names{"z9.0.tif", "z9.5.tif", "z10.0.tif", "z10.5.tif"}));
  // Places in micrometres, rounded.
  EXPECT_EQ(ordered({"z_0.33.tif", "z_0.67.tif", "z_1.00.tif", "z_1.33.tif"}).size(), 4U);
  expect_error(
      [] {
        (void)ordered({"z0.5.tif", "z0.10.tif", "z0.15.tif"});
      },
      {"folder", "order", "z0.5.tif", "decimals"});
}

TEST(SliceOrder, MissingSlicesAreNamed) {
  expect_error(
      [] {
        (void)ordered({"s_0009.tif", "s_0010.tif", "s_0013.tif", "s_0014.tif"});
      },
      {"folder", "2 of", "missing", "s_0011", "s_0012"});
  expect_error([] { (void)ordered({"a2.tif", "a4.tif", "a8.tif"}); }, {"1 of", "a6"});
  expect_error(
      [] {
        (void)ordered({"a1.tif", "a2.tif", "a1000.tif"});
      },
      {"997 of", "a3", "and 985 more"});
}

TEST(SliceOrder, ASeriesInStepsIsReadWithARemark) {
  const SliceOrder order = order_slices({"a0.tif", "a5.tif", "a10.tif"}, "folder");
  ASSERT_EQ(order.remarks.size(), 2U);
  EXPECT_NE(order.remarks[0].find("from a0.tif to a10.tif"), std::string::npos);
  EXPECT_NE(order.remarks[1].find("steps of 5"), std::string::npos);
}

TEST(SliceOrder, SeveralSeriesAreListed) {
  expect_error(
      [] {
        (void)ordered({"a1.tif", "a2.tif", "b1.tif", "b2.tif"});
      },
      {"2 series", "a1.tif to a2.tif (2 files)", "b1.tif to b2.tif (2 files)"});
  expect_error(
      [] {
        (void)ordered({"s1_1.tif", "s1_2.tif", "s2_1.tif", "s2_2.tif"});
      },
      {"2 series", "s1_1.tif", "s2_2.tif"});
  expect_error(
      [] {
        (void)ordered({"s1.tif", "s2.tif", "preview.tif"});
      },
      {"2 series", "preview.tif"});
  expect_error([] { (void)ordered({"s1.tif", "s01.tif", "s2.tif"}); }, {"same number", "s01.tif"});
  // Two numbers that go up together are one series.
  EXPECT_EQ(ordered({"s_1_z30.tif", "s_2_z60.tif", "s_3_z90.tif"}).size(), 3U);
}

}  // namespace
}  // namespace reckon
