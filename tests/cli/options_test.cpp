// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cli/program_fixture.hpp"

namespace reckon {
namespace {

using testing::Outcome;

/// Options with values that no one can mean are refused before any work is done.
class OptionsTest : public testing::ProgramTest {
 protected:
  /// What is said of wrong options; nothing where they were taken.
  [[nodiscard]] std::string refusal(std::vector<std::string> arguments) const {
    const Outcome outcome = reckon(std::move(arguments));
    if (outcome.code != 1 || !outcome.out.empty()) return {};
    return outcome.err;
  }
};

TEST_F(OptionsTest, NoNumberIsNoNumber) {
  EXPECT_EQ(refusal({"check", "scene.toml", "--timing", "nan"}),
            "reckon: error: --timing: nan is not a number\nSee: reckon check --help\n");
  EXPECT_NE(refusal({"run", "scene.toml", "--safety-minutes", "-NaN"}), "");
}

TEST_F(OptionsTest, CountsAreNotNegative) {
  EXPECT_EQ(refusal({"run", "scene.toml", "--steps", "99999999999999999999"}),
            "reckon: error: --steps: Value 99999999999999999999 not in range 1 to "
            "1000000000000000\nSee: reckon run --help\n");
  EXPECT_NE(
      refusal({"grains", "scan", "scene.toml", "--voxel", "0.2mm", "--out", "scan", "--seed", "-1"})
          .find("--seed: -1 is not a whole number from 0 on\nSee: reckon grains scan --help"),
      std::string::npos);
  EXPECT_NE(refusal({"grains", "scan", "scene.toml", "--voxel", "0.2mm", "--out", "scan",
                     "--memory", "-1GB"}),
            "");
  EXPECT_FALSE(std::filesystem::exists(root_ / "scan"));
}

TEST_F(OptionsTest, AScanHasGraysThatItsTypeHolds) {
  const std::string said = refusal(
      {"grains", "scan", "scene.toml", "--voxel", "0.2mm", "--out", "scan", "--type", "uint8"});
  EXPECT_NE(said.find("uint8 cannot hold a gray value of 10000"), std::string::npos) << said;
  EXPECT_EQ(refusal({"grains", "scan", "scene.toml", "--voxel", "0.2mm", "--out", "scan", "--type",
                     "uint8", "--void-gray", "38", "--solid-gray", "153"}),
            "");
  EXPECT_TRUE(std::filesystem::exists(root_ / "scan"));
}

TEST_F(OptionsTest, StrainsThatNobodyHasAreNotZero) {
  ASSERT_EQ(refusal({"run", "scene.toml", "--steps", "100", "--quiet"}), "");
  const Outcome none = reckon({"analyse", "scene.run", "--longest-edge", "1nm", "--json"});
  EXPECT_EQ(none.code, 0) << none.err;
  EXPECT_NE(none.out.find("\"shear_mean\": null"), std::string::npos) << none.out;
}

}  // namespace
}  // namespace reckon
