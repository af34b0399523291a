// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Whole runs on a disk that fails once, or that is full from some moment on. failing_calls.cpp is
// loaded in front of the program.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "cli/program_fixture.hpp"
#include "reckon/results/run_record.hpp"

namespace reckon {
namespace {

using testing::Outcome;

class FaultyDisk : public testing::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    write("scene.toml", scene_text("[time]\nsteps = 40\n[output]\nhistory_interval = 10\n"
                                   "fields_interval = 20\ncheckpoint_interval = 20\n"));
    ASSERT_EQ(reckon({"run", "scene.toml", "--quiet", "--out", "good.run"}).code, 0);
  }
  /// The program with calls of the system that fail. It reports a failed call on standard error.
  [[nodiscard]] Outcome with_fault(const std::string& call, std::uint64_t number, bool lasting,
                                   const std::string& arguments) const {
    const std::string settings = "RECKON_FAIL_CALL=" + call + " RECKON_FAIL_FILE=scene.run" +
                                 " RECKON_FAIL_NUMBER=" + std::to_string(number) +
                                 (lasting ? " RECKON_FAIL_LASTING=1" : "");
    return outcome_of(start_line(
        {"/bin/bash", "-c",
         settings + " LD_PRELOAD=" RECKON_FAILING_CALLS " " RECKON_PROGRAM " " + arguments}));
  }
  [[nodiscard]] bool is_as_good(const std::string& run) const {
    return reckon({"diff", "good.run", run}).code == 0;
  }
  [[nodiscard]] std::string status() const { return recorded_status(root_ / "scene.run/run.json"); }

  /// Fails the first, second, third ... and then fewer and fewer of the calls, until a run has none
  /// that fails. Returns how many runs a call has failed in.
  int fail_many(const std::string& call, bool lasting) {
    int failed = 0;
    for (std::uint64_t number = 1; number < 10000; number += 1 + number / 4) {
      std::filesystem::remove_all(root_ / "scene.run");
      const Outcome outcome =
          with_fault(call, number, lasting, "run scene.toml --quiet --out scene.run");
      const std::string what = call + " " + std::to_string(number) + ": " + outcome.err;
      if (outcome.err.find("a call has failed") == std::string::npos) {
        EXPECT_EQ(outcome.code, 0) << what;
        return failed;
      }
      ++failed;
      if (outcome.code == 0) {
        EXPECT_TRUE(is_as_good("scene.run")) << what;
        continue;
      }
      EXPECT_TRUE(outcome.code == 2 || call != "write") << outcome.code << what;
      EXPECT_NE(outcome.err.find("reckon: error: "), std::string::npos) << what;
      EXPECT_EQ(outcome.err.find("fault of reckon"), std::string::npos) << what;
      EXPECT_NE(status(), "running") << what;
      const Outcome resumed = reckon(
          {"run", "scene.toml", "--quiet", "--out", "scene.run",
           std::filesystem::exists(root_ / "scene.run/run.log") ? "--resume" : "--overwrite"});
      EXPECT_EQ(resumed.code, 0) << what << resumed.err;
      EXPECT_TRUE(is_as_good("scene.run")) << what;
      if (HasFailure()) return failed;
    }
    ADD_FAILURE() << "no end to " << call;
    return failed;
  }
};

TEST_F(FaultyDisk, ACallThatFailsOnceLeavesNothingWrong) {
  for (const char* call : {"write", "read", "lseek", "fsync", "close", "rename", "ftruncate"}) {
    const int failed = fail_many(call, false);
    EXPECT_TRUE(failed > 20 || std::string{call} != "write") << failed;
  }
}

TEST_F(FaultyDisk, ALibraryIsWholeOrNotThere) {
  const std::string command = "grains spheres grains.h5 -o scene.run.h5";
  ASSERT_EQ(with_fault("write", 0, false, command).code, 0);
  const std::string good = read_file(root_ / "scene.run.h5");
  for (const char* call : {"write", "fsync", "close", "rename"}) {
    std::uint64_t number = 1;
    for (; number < 1000; number += 1 + number / 8) {
      std::filesystem::remove(root_ / "scene.run.h5");
      const Outcome outcome = with_fault(call, number, false, command);
      const std::string what = call + (" " + std::to_string(number)) + ": " + outcome.err;
      const bool there = std::filesystem::exists(root_ / "scene.run.h5");
      EXPECT_EQ(there, outcome.code == 0) << what;
      EXPECT_TRUE(!there || read_file(root_ / "scene.run.h5") == good) << what;
      if (outcome.err.find("a call has failed") == std::string::npos) break;
      EXPECT_TRUE(outcome.code != 0 || std::string{call} != "write") << what;
    }
    EXPECT_GT(number, 1U) << call << " was never made";
  }
}

TEST_F(FaultyDisk, AFullDiskEndsTheRunAndIsNamed) {
  EXPECT_GT(fail_many("write", true), 20);
  std::filesystem::remove_all(root_ / "scene.run");
  const Outcome outcome = with_fault("write", 60, true, "run scene.toml --quiet --out scene.run");
  EXPECT_EQ(outcome.code, 2);
  for (const char* part : {"No space left on device", "the disk at /", " free of ", "Make room"}) {
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace reckon
