// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <string>

#include "cli/program_fixture.hpp"

namespace reckon {
namespace {

using testing::Outcome;
using MemoryLimitTest = testing::ProgramTest;

/// What takes more memory than there is gets refused before it is made.
TEST_F(MemoryLimitTest, SizesAreHeldAgainstTheMemory) {
  std::string many = scene_text(usual);
  many.replace(many.find("count = 24"), 10, "count = 100000000");
  write("many.toml", many);
  const Outcome fill = outcome_of(
      start_line({"/bin/sh", "-c",
                  "ulimit -v 16000000; exec " RECKON_PROGRAM " check many.toml --threads 1"}));
  EXPECT_EQ(fill.code, 1) << fill.err;
  EXPECT_NE(fill.err.find("100000000 grains would take"), std::string::npos) << fill.err;
}

}  // namespace
}  // namespace reckon
