// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>
#include <string>

#include "cli/program_fixture.hpp"

namespace reckon {
namespace {

using testing::Outcome;

/// What becomes of commands whose standard output is closed, full, or read no more.
class StreamsTest : public testing::ProgramTest {
 protected:
  /// `$0` stands for the program.
  [[nodiscard]] testing::Process start(const std::string& line) const {
    return start_line({"/bin/bash", "-c", line, RECKON_PROGRAM});
  }
  [[nodiscard]] Outcome shell(const std::string& line) const { return outcome_of(start(line)); }
  [[nodiscard]] std::string log() const { return read_file(RunFolder{root_ / "scene.run"}.log()); }
  /// Prints something after every few steps.
  void write_scene_of_many_stages() const {
    std::string many;
    for (int i = 0; i < 40; ++i) many += fmt::format("[[stage]]\nname = \"s{}\"\nsteps = 2\n", i);
    write("scene.toml", scene_text("[time]\n[output]\nhistory_interval = 2\n" + many));
  }
};

TEST_F(StreamsTest, ARunOutlivesTheReaderOfItsLog) {
  write_scene_of_many_stages();
  const Outcome outcome = shell("set -o pipefail; $0 run scene.toml | head -n 1");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(log().find("complete at step 80"), std::string::npos) << log();
}

TEST_F(StreamsTest, ARunOutlivesAFullDiskOfItsLog) {
  write_scene_of_many_stages();
  const Outcome outcome = shell("$0 run scene.toml > /dev/full");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(log().find("complete at step 80"), std::string::npos) << log();
}

TEST_F(StreamsTest, AnAnswerThatIsLostIsNoSuccess) {
  const Outcome outcome = shell("$0 check scene.toml --timing 0 --json > /dev/full");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("standard output cannot be written"), std::string::npos)
      << outcome.err;
}

TEST_F(StreamsTest, ClosedStreamsAreNobodysFiles) {
  EXPECT_EQ(shell("$0 run scene.toml --steps 12 <&- >&- 2>&-").code, 0);
  EXPECT_EQ(shell("$0 run scene.toml --steps 12 --out open.run").code, 0);
  EXPECT_EQ(shell("$0 diff scene.run open.run").code, 0);
  EXPECT_EQ(shell("$0 run missing.toml <&- >&- 2>&-").code, 1);
}

TEST_F(StreamsTest, AClosedTerminalLeavesACheckpoint) {
  write("scene.toml", scene_text("[time]\nsteps = 400000\n[output]\nhistory_interval = 10\n"));
  testing::Process process = start("exec $0 run scene.toml");
  wait_for_rows("scene.run", 3);
  process.send(SIGHUP);
  process.send(SIGHUP);  // shell and kernel may send one each
  EXPECT_EQ(process.wait(), 143) << process.err();
  EXPECT_EQ(RunFolder{root_ / "scene.run"}.checkpoint_steps().size(), 1U);
}

TEST_F(StreamsTest, UnderNohupAClosedTerminalDoesNotStopARun) {
  write("scene.toml", scene_text("[time]\nsteps = 4000\n[output]\nhistory_interval = 10\n"));
  testing::Process process = start("trap '' HUP; exec $0 run scene.toml");
  wait_for_rows("scene.run", 3);
  process.send(SIGHUP);
  EXPECT_EQ(process.wait(), 0) << process.err();
}

TEST_F(StreamsTest, AFolderThatCannotBeChangedIsNoFaultOfReckon) {
  ASSERT_EQ(shell("$0 run scene.toml --steps 2").code, 0);
  write("file", "in the way");
  const Outcome outcome = shell("$0 grains export grains.h5 --out file/look");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_EQ(outcome.err.find("fault of reckon"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace reckon
