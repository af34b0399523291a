// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cli/program_fixture.hpp"
#include "reckon/text/free_memory.hpp"

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
          .find("--seed: -1 is not a whole number of 0 or more\nSee: reckon grains scan --help"),
      std::string::npos);
  EXPECT_NE(refusal({"grains", "scan", "scene.toml", "--voxel", "0.2mm", "--out", "scan",
                     "--memory", "-1GB"}),
            "");
  EXPECT_FALSE(std::filesystem::exists(root_ / "scan"));
}

TEST_F(OptionsTest, NumbersThatAreNearlyRightComeWithTheRightOne) {
  const auto said = [&](const std::string& option, const std::string& value) {
    return refusal({"run", "scene.toml", option, value});
  };
  const std::string help = "\nSee: reckon run --help\n";
  EXPECT_EQ(said("--steps", "1e5"),
            "reckon: error: --steps: 1e5 is not a whole number. Write 100000." + help);
  EXPECT_EQ(said("--steps", "2.5"), "reckon: error: --steps: 2.5 is not a whole number" + help);
  EXPECT_EQ(said("--steps", "10k"),
            "reckon: error: --steps: 10k is not a whole number. Write 10000." + help);
  EXPECT_EQ(said("--steps", "1,000,000"),
            "reckon: error: --steps: 1,000,000 is not a whole number. Write 1000000." + help);
  EXPECT_EQ(said("--safety-minutes", "0,5"),
            "reckon: error: --safety-minutes: 0,5 is not a number. Decimals have a point: write "
            "0.5." +
                help);
  EXPECT_EQ(
      said("--safety-minutes", "10min"),
      "reckon: error: --safety-minutes: 10min is not a number. Write it without a unit." + help);
  EXPECT_NE(refusal({"grains", "generate", "--count", "2", "--d50", "0,5mm", "-o", "x.h5"})
                .find("--d50: \"0,5mm\" cannot be read. Decimals have a point: write 0.5mm."),
            std::string::npos);
  EXPECT_NE(refusal({"grains", "generate", "--count", "2", "--d50", "1mm", "--roundness", "50%",
                     "-o", "x.h5"})
                .find("--roundness: 50% is not a number. Write 0.5."),
            std::string::npos);
}

TEST_F(OptionsTest, AnOptionThatIsNotThereComesWithTheNearest) {
  const auto said = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"run", "scene.toml"});
    const std::string text = refusal(arguments);
    return text.substr(0, text.find('\n'));
  };
  const std::string no_option = "reckon: error: `reckon run` has no option ";
  EXPECT_EQ(said({"--thread", "2"}), no_option + "--thread. Did you mean --threads?");
  EXPECT_EQ(said({"--Threads=2"}), no_option + "--Threads. Did you mean --threads?");
  EXPECT_EQ(said({"-threads", "2"}), no_option + "-threads. Did you mean --threads?");
  EXPECT_EQ(said({"--safety_minutes", "2"}),
            no_option + "--safety_minutes. Did you mean --safety-minutes?");
  EXPECT_EQ(said({"--timing", "2"}), no_option + "--timing. `reckon check` has it.");
  EXPECT_EQ(said({"--xyzzy"}).find(no_option + "--xyzzy. There are --"), 0U);
  EXPECT_EQ(said({"threads=2"}),
            "reckon: error: `reckon run` takes no argument \"threads=2\". Did you mean --threads?");
  EXPECT_EQ(
      said({"--threads"}).find("reckon: error: --threads needs a value: N: Number of threads"), 0U);
  EXPECT_NE(refusal({"grains", "generate", "--count", "2", "--d50", "1", "mm", "-o", "x.h5"})
                .find("takes no argument \"mm\". Write a number and its unit without a space, for "
                      "example 1mm"),
            std::string::npos);
}

TEST_F(OptionsTest, AWordThatIsNotThereComesWithTheNearest) {
  EXPECT_EQ(
      refusal({"grains", "export", "grains.h5", "--format", "slt", "--out", "x"}),
      "reckon: error: --format: \"slt\" is not one of vtp, stl. Did you mean stl?\nSee: reckon "
      "grains export --help\n");
  EXPECT_NE(refusal({"grains", "generate", "--count", "2", "--d50", "1mm", "-o", "x.h5",
                     "--storage", "bnad"})
                .find("--storage: \"bnad\" is not one of band, full. Did you mean band?"),
            std::string::npos);
  EXPECT_NE(refusal({"bench", "dence"}).find("Did you mean dense?"), std::string::npos);
  EXPECT_EQ(refusal({"run"}),
            "reckon: error: scene is missing: Scene file (TOML)\nSee: reckon run --help\n");
  EXPECT_EQ(refusal({"run", "scene.toml", "--threads", "2", "--threads", "3"}),
            "reckon: error: --threads is given more than once\nSee: reckon run --help\n");
  EXPECT_NE(refusal({"check", "grains.h5"}).find("this is not a text. Give a scene"),
            std::string::npos);
}

TEST_F(OptionsTest, ACommandThatIsNotThereComesWithTheNearest) {
  EXPECT_EQ(refusal({"grains", "scann", "a"}),
            "reckon: error: there is no command \"scann\". Did you mean `reckon grains scan`?\n");
  EXPECT_EQ(refusal({"scene.toml"}),
            "reckon: error: there is no command \"scene.toml\". Did you mean `reckon run "
            "scene.toml`?\n");
  EXPECT_EQ(refusal({"help"}),
            "reckon: error: there is no command \"help\". Did you mean `reckon --help`?\n");
}

TEST_F(OptionsTest, AnOptionIsNoValueOfAnother) {
  EXPECT_EQ(refusal({"run", "scene.toml", "--out", "--quiet"}),
            "reckon: error: --out: needs a value, and --quiet is an option. Write a name that "
            "begins with -- as ./--quiet\nSee: reckon run --help\n");
  EXPECT_FALSE(std::filesystem::exists(root_ / "--quiet"));
}

TEST_F(OptionsTest, DecimalCommasBetweenLengths) {
  for (const char* solid : {"--sphere=0,5mm", "--box=1,5mm,2mm,3mm"}) {
    EXPECT_NE(refusal({"grains", "solid", solid, "-o", "x.h5"}).find("decimals have a point"),
              std::string::npos)
        << solid;
  }
  EXPECT_NE(refusal({"grains", "solid", "--sphere", "1e300m", "-o", "x.h5"})
                .find("lengths go from 1e-12 to 1e+06 m"),
            std::string::npos);
}

TEST_F(OptionsTest, AFileOfTheUsersIsNotReplacedByALibrary) {
  const std::string before = read_file(root_ / "scene.toml");
  EXPECT_EQ(refusal({"grains", "solid", "--sphere", "1mm", "-o", "scene.toml"}),
            "reckon: error: scene.toml: is not replaced (there is another file of this name, no "
            "shape library). Give another name, or remove that file first.\n");
  EXPECT_NE(refusal({"grains", "spheres", "grains.h5", "-o", "scene.toml"}), "");
  EXPECT_EQ(read_file(root_ / "scene.toml"), before);
  const Outcome again = reckon({"grains", "spheres", "grains.h5", "-o", "grains.h5"});
  EXPECT_EQ(again.code, 0) << again.err;
}

TEST_F(OptionsTest, SizesOfGrainsAreHeldAgainstTheMemory) {
  constexpr double grid_of_a_thousand = 44e9;
  if (static_cast<double>(free_memory()) > grid_of_a_thousand) {
    GTEST_SKIP() << "this machine has the memory";
  }
  const std::string said = refusal({"grains", "solid", "--sphere", "1mm", "--voxels-per-diameter",
                                    "1000", "--threads", "1", "-o", "x.h5"});
  EXPECT_NE(said.find("a grid of 1000 voxels per diameter would take 43.9 GB of memory"),
            std::string::npos)
      << said;
}

/// The library of a scan names the command and the files it comes from.
TEST_F(OptionsTest, TheLibraryOfAScanSaysHowItWasMade) {
  const auto made = [&](const std::string& library) {
    const Outcome info = reckon({"grains", "info", library, "--json"});
    EXPECT_EQ(info.code, 0) << info.err;
    return info.out;
  };
  const auto expect_in = [](const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
      EXPECT_NE(text.find(part), std::string::npos) << part << " in: " << text;
    }
  };
  ASSERT_EQ(reckon({"grains", "scan", "scene.toml", "--voxel", "0.1mm", "--format", "raw", "--out",
                    "scan"})
                .code,
            0);
  expect_in(made("scan/library.h5"), {"\"scan\"", "\"--voxel\"", "scene.toml", "grains.h5"});
  const Outcome cut = reckon({"grains", "from-scan", "scan/volume.raw", "--voxel", "0.1mm",
                              "--keep-border", "--out", "cut"});
  if (cut.err.find("built without") != std::string::npos) GTEST_SKIP() << cut.err;
  ASSERT_EQ(cut.code, 0) << cut.err;
  expect_in(made("cut/library.h5"),
            {"\"from-scan\"", "\"--keep-border\"", "scan/volume.raw\"", "scan/volume.raw.txt"});
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
