// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstddef>
#include <string>
#include <utility>

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

/// On a terminal (script(1) provides one) long work draws a bar, and takes it away again. What is
/// long depends on the machine: the work grows until a bar has been drawn.
TEST_F(StreamsTest, LongWorkDrawsABarOnATerminal) {
  const auto drawn_at_last = [&](std::size_t amount, const auto& line_of) {
    std::string out;
    for (int growth = 0; growth < 6; ++growth, amount *= 4) {
      const std::string line = RECKON_PROGRAM + line_of(amount);
      out = outcome_of(start_line({"/usr/bin/script", "-qec", line, "/dev/null"})).out;
      if (out.find("\r\033[K[") != std::string::npos) return std::pair{out, amount};
    }
    ADD_FAILURE() << "no bar: " << out;
    return std::pair{out, amount};
  };
  const auto [run, steps] = drawn_at_last(4000, [&](std::size_t amount) {
    write("long.toml", scene_text(fmt::format(
                           "[time]\nsteps = {0}\n[output]\nhistory_interval = {0}\n", amount)));
    return std::string{" run long.toml --overwrite"};
  });
  EXPECT_NE(run.find(" steps/s"), std::string::npos) << run;
  // The bar is wiped before the first line of the summary, whatever that says.
  EXPECT_TRUE(run.find(fmt::format("\r\033[Kcomplete at step {}", steps)) != std::string::npos ||
              run.find("\r\033[KTHE FIGURES") != std::string::npos)
      << run;
  EXPECT_NE(run.find(fmt::format("complete at step {}", steps)), std::string::npos) << run;
  const auto [made, grains] = drawn_at_last(12, [](std::size_t amount) {
    return fmt::format(
        " grains generate --count {} --voxels-per-diameter 40 --threads 1 -o many.h5", amount);
  });
  EXPECT_NE(made.find(fmt::format(" of {} grains", grains)), std::string::npos) << made;
  EXPECT_NE(made.find(fmt::format("\r\033[Kmany.h5: {} grains", grains)), std::string::npos)
      << made;
}

}  // namespace
}  // namespace reckon
