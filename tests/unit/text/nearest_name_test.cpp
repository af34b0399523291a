// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/text/nearest_name.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace reckon {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsReplacementsAndSwaps) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("friction", "friction"), 0U);
  EXPECT_EQ(edit_distance("fricton", "friction"), 1U);
  EXPECT_EQ(edit_distance("firction", "friction"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

TEST(NearestName, FindsTheLikeliestOrNone) {
  const std::vector<std::string> names{"friction", "density", "normal_stiffness", "law"};
  EXPECT_EQ(nearest_name("nromal_stifness", names), "normal_stiffness");
  EXPECT_EQ(nearest_name("densty", names), "density");
  EXPECT_EQ(nearest_name("colour", names), std::nullopt);
  EXPECT_EQ(nearest_name("x", names), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(100000, 'f'), names), std::nullopt);
}

}  // namespace
}  // namespace reckon
