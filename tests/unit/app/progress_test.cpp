// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "progress.hpp"

#include <gtest/gtest.h>

namespace reckon::app {
namespace {

TEST(BarLine, FillsWithTheShareAndNeverWraps) {
  EXPECT_EQ(bar_line(0, "0 of 9", 80), "[..............................]   0 %  0 of 9");
  EXPECT_EQ(bar_line(0.5, "half", 80), "[###############...............]  50 %  half");
  EXPECT_EQ(bar_line(1, "all", 80), "[##############################] 100 %  all");
  EXPECT_EQ(bar_line(0.5, "half", 25), "[#####.....]  50 %  half");
  EXPECT_EQ(bar_line(0.5, "a text that is wider", 15), " 50 %  a text ");
  for (std::size_t width = 1; width < 60; ++width) {
    EXPECT_LT(bar_line(0.3, "12 of 40 grains", width).size(), width);
  }
}

TEST(CountDisplay, IsSilentWithoutATerminal) {
  ::testing::internal::CaptureStderr();
  {
    CountDisplay display{"grains"};
    for (std::size_t n = 0; n <= 100; ++n) display.show(n, 100);
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace reckon::app
