// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// `mpirun -np N reckon run`: files, restarts, failures and signals, as a user meets them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "cli/program_fixture.hpp"
#include "reckon/domain/decomposition_names.hpp"
#include "reckon/output/history.hpp"

namespace reckon {
namespace {

using testing::Outcome;

class MpiRun : public testing::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    std::istringstream settings{RECKON_MPI_SETTINGS};
    for (std::string setting; settings >> setting;) {
      const std::size_t equals = setting.find('=');
      ::setenv(setting.substr(0, equals).c_str(), setting.substr(equals + 1).c_str(), 1);
    }
  }
  [[nodiscard]] testing::Process start(int ranks, std::vector<std::string> arguments) const {
    std::vector<std::string> line{RECKON_MPIEXEC, RECKON_MPIEXEC_COUNT, std::to_string(ranks),
                                  RECKON_PROGRAM};
    line.insert(line.end(), arguments.begin(), arguments.end());
    return start_line(std::move(line));
  }
  [[nodiscard]] Outcome reckon(int ranks, std::vector<std::string> arguments) const {
    return outcome_of(start(ranks, std::move(arguments)));
  }
  static std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
      ++found;
    }
    return found;
  }
  static std::string with_decomposition(const std::string& name) {
    return scene_text(std::string{usual} + "[parallel]\ndecomposition = \"" + name + "\"\n");
  }
};

TEST_F(MpiRun, DrawsNoBarIntoALog) {
  write("long.toml", scene_text("[time]\nsteps = 6000\n[output]\nhistory_interval = 10\n"));
  for (const int ranks : {1, 2}) {
    const Outcome outcome = reckon(ranks, {"run", "long.toml", "--overwrite"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find('\033'), std::string::npos) << outcome.out;
  }
}

TEST_F(MpiRun, LeavesTheFilesOfOneRank) {
  ASSERT_EQ(reckon(1, {"run", "scene.toml", "--out", "one"}).code, 0);
  for (const auto& known : decomposition_names) {
    const std::string decomposition{known.first};
    write("several.toml", with_decomposition(decomposition));
    const Outcome outcome =
        reckon(3, {"run", "several.toml", "--out", decomposition, "--threads", "2"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(count(outcome.out, "complete at step 600"), 1U) << outcome.out;
    auto one = files_of(root_ / "one");
    auto several = files_of(root_ / decomposition);
    // These two depend on the decomposition.
    for (const char* file : {"scene.toml", "scene_resolved.toml"}) {
      one.erase(file);
      several.erase(file);
    }
    ASSERT_EQ(one.size(), several.size());
    for (const auto& [name, content] : one) {
      if (name.find("checkpoints/") == 0) continue;  // hold the scene; compared by diff
      EXPECT_TRUE(several[name] == content) << decomposition << ": " << name << " differs";
    }
    const Outcome diff = reckon(1, {"diff", "one", decomposition});
    EXPECT_EQ(diff.code, 0) << diff.out;
  }
}

TEST_F(MpiRun, StagesLeaveTheFilesOfOneRankWhateverRanksTheyGoOnWith) {
  write("staged.toml", staged());
  ASSERT_EQ(reckon(1, {"run", "staged.toml", "--out", "one"}).code, 0);
  ASSERT_EQ(reckon(3, {"run", "staged.toml", "--out", "three"}).code, 0);
  expect_equal_folders(root_ / "three", root_ / "one");
  ASSERT_EQ(reckon(3, {"run", "staged.toml", "--out", "parts", "--steps", "411"}).code, 0);
  ASSERT_EQ(reckon(2, {"run", "staged.toml", "--out", "parts", "--steps", "800", "--resume"}).code,
            0);
  ASSERT_EQ(reckon(4, {"run", "staged.toml", "--out", "parts", "--resume"}).code, 0);
  expect_equal_folders(root_ / "parts", root_ / "one");
}

TEST_F(MpiRun, GoesOnWithAnotherNumberOfRanks) {
  ASSERT_EQ(reckon(1, {"run", "scene.toml", "--out", "whole"}).code, 0);
  ASSERT_EQ(reckon(3, {"run", "scene.toml", "--out", "parts", "--steps", "170"}).code, 0);
  ASSERT_EQ(reckon(1, {"run", "scene.toml", "--out", "parts", "--steps", "330", "--resume"}).code,
            0);
  write("scene_grid.toml", with_decomposition("grid"));
  ASSERT_EQ(
      reckon(2, {"run", "scene_grid.toml", "--out", "parts", "--steps", "440", "--resume"}).code,
      0);
  const Outcome last = reckon(4, {"run", "scene.toml", "--out", "parts", "--resume"});
  ASSERT_EQ(last.code, 0) << last.err;
  expect_equal_folders(root_ / "whole", root_ / "parts");
}

TEST_F(MpiRun, GrainsThatLeaveAreCountedOnAnyNumberOfRanks) {
  // Whoever comes down to the floor leaves; the plate presses the rest down.
  write("leaky.toml",
        scene_text("[[outflow]]\nplane = { point = [0, 0, \"1.1 mm\"], normal = [0, 0, 1] }\n" +
                   std::string{usual}));
  const Outcome one = reckon(1, {"run", "leaky.toml", "--out", "one"});
  ASSERT_EQ(one.code, 0) << one.err;
  ASSERT_EQ(reckon(3, {"run", "leaky.toml", "--out", "three", "--steps", "400"}).code, 0);
  ASSERT_EQ(reckon(2, {"run", "leaky.toml", "--out", "three", "--resume"}).code, 0);
  expect_equal_folders(root_ / "one", root_ / "three");
  const HistoryTable history = read_history(root_ / "one" / "history.csv");
  const auto column = [&](const std::string& name) {
    return std::stod(history.rows.back()[static_cast<std::size_t>(
        std::find(history.header.begin(), history.header.end(), name) - history.header.begin())]);
  };
  EXPECT_GT(column("departed"), 2);
  EXPECT_LT(column("departed"), 24);
  EXPECT_EQ(column("departed") + column("grains"), 24);
}

TEST_F(MpiRun, MoreRanksThanGrains) {
  std::string text = scene_text(usual);
  text.replace(text.find("count = 24"), 10, "count = 2");
  write("few.toml", text);
  ASSERT_EQ(reckon(1, {"run", "few.toml", "--out", "one"}).code, 0);
  const Outcome outcome = reckon(5, {"run", "few.toml", "--out", "five"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  expect_equal_folders(root_ / "one", root_ / "five");
}

TEST_F(MpiRun, AFaultySceneIsToldOnce) {
  write("bad.toml", scene_text("[time]\nstps = 10\n"));
  const Outcome outcome = reckon(3, {"run", "bad.toml"});
  EXPECT_NE(outcome.code, 0);
  EXPECT_EQ(count(outcome.err, "stps"), 1U) << outcome.err;
  const Outcome missing = reckon(3, {"run", "nowhere.toml"});
  EXPECT_NE(missing.code, 0);
  EXPECT_EQ(count(missing.err, "nowhere.toml"), 1U) << missing.err;
  const Outcome wrong_command = reckon(2, {"check", "scene.toml"});
  EXPECT_NE(wrong_command.code, 0);
  EXPECT_EQ(count(wrong_command.err, "only `reckon run` uses several processes"), 1U);
}

TEST_F(MpiRun, ABrokenMotionNamesGrainStepAndCheckpointOnce) {
  // The walls' speed leaves no time to react: forces grow until they are no numbers.
  std::string text = scene_text(
      "[time]\nstep = 1e-2\nsteps = 20000\n[output]\nhistory_interval = 0\ncheckpoint_interval = "
      "1\n");
  write("broken.toml", text);
  const Outcome outcome = reckon(3, {"run", "broken.toml"});
  EXPECT_NE(outcome.code, 0);
  EXPECT_EQ(count(outcome.err, "its motion is no longer a number"), 1U) << outcome.err;
  EXPECT_EQ(count(outcome.err, "The last checkpoint is"), 1U) << outcome.err;
  EXPECT_NE(outcome.err.find("grain "), std::string::npos) << outcome.err;
}

TEST_F(MpiRun, ASignalToMpirunWritesACheckpoint) {
  write("long.toml", scene_text("[time]\nsteps = 6000\n[output]\nhistory_interval = 25\n"
                                "checkpoint_interval = 0\n"));
  ASSERT_EQ(reckon(1, {"run", "long.toml", "--out", "whole"}).code, 0);
  testing::Process process = start(2, {"run", "long.toml", "--out", "parts"});
  wait_for_rows("parts", 3);
  process.send(SIGUSR1);
  EXPECT_NE(process.wait(), 0);
  EXPECT_EQ(count(process.err(), "checkpoint written"), 1U) << process.err();
  const Outcome resumed = reckon(3, {"run", "long.toml", "--out", "parts", "--resume"});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_NE(resumed.out.find("resumed from the checkpoint of step"), std::string::npos);
  expect_equal_folders(root_ / "whole", root_ / "parts");
}

TEST_F(MpiRun, ALostRankEndsTheRunWhichGoesOnFromItsCheckpoint) {
  write("long.toml", scene_text("[time]\nsteps = 6000\n[output]\nhistory_interval = 25\n"
                                "checkpoint_interval = 200\n"));
  testing::Process process = start(3, {"run", "long.toml", "--out", "parts"});
  wait_for_rows("parts", 20);
  ASSERT_EQ(testing::kill_one_child(process.id()), 1);
  EXPECT_NE(process.wait(), 0);  // and it does come to an end
  const Outcome resumed = reckon(2, {"run", "long.toml", "--out", "parts", "--resume"});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  ASSERT_EQ(reckon(1, {"run", "long.toml", "--out", "whole"}).code, 0);
  expect_equal_folders(root_ / "whole", root_ / "parts");
}

TEST_F(MpiRun, AFullDiskIsToldOnceAndEndsAllRanks) {
  std::filesystem::create_directories(root_ / "full");
  std::filesystem::create_symlink("/dev/full", root_ / "full" / "history.csv");
  const Outcome outcome = reckon(3, {"run", "scene.toml", "--out", "full", "--overwrite"});
  EXPECT_NE(outcome.code, 0);
  EXPECT_EQ(count(outcome.err, "reckon: error"), 1U) << outcome.err;
}

}  // namespace
}  // namespace reckon
