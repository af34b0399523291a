// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <string>

#include "cli/program_fixture.hpp"

namespace reckon {
namespace {

using testing::Outcome;
using QuietRun = testing::ProgramTest;

TEST_F(QuietRun, NodesThatCannotSeeTheirPartnerMakeARunInvalid) {
  Shape small = testing::bumpy_grain(0.001, 120, 16);
  small.name = "small";
  save_library(root_ / "grains.h5", {testing::bumpy_grain(0.01, 120, 16), small});
  write("large_first.toml", R"(
[contact]
normal_stiffness = "2e9 N/m^3"
master = "lower_id"
[time]
steps = 1
[[grains]]
library = "grains.h5"
place = [{ position = [0, 0, 0] }, { position = [0, 0, "30 mm"] }]
)");
  const Outcome run = reckon({"run", "large_first.toml", "--quiet"});
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.out, "");
  EXPECT_NE(run.err.find("MEAN NOTHING"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("contact.master = \"both\""), std::string::npos) << run.err;
  const std::string record = read_file(root_ / "large_first.run/run.json");
  EXPECT_NE(record.find("\"valid\": false"), std::string::npos) << record;
  EXPECT_NE(record.find("\"code\": \"coarse_nodes\""), std::string::npos) << record;
  const Outcome later = reckon({"report", "large_first.run"});
  EXPECT_NE(later.out.find("MEAN NOTHING"), std::string::npos) << later.out;
}

}  // namespace
}  // namespace reckon
