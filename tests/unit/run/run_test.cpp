// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/run/run.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/output/history.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/results/run_diff.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

using RunTest = testing::RunSceneTest;

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(RunTest, WritesWhatTheSceneAsksFor) {
  const RunReport report = run(scene_text(usual), {.folder = root_ / "a"});
  EXPECT_EQ(report.end, RunEnd::complete);
  EXPECT_EQ(report.progress.step, 600U);
  EXPECT_GT(report.last.contacts, 5U);
  EXPECT_GT(report.last.wall_contacts, 0U);
  const RunFolder folder{root_ / "a"};
  EXPECT_EQ(folder.checkpoint_steps(), (std::vector<std::uint64_t>{150, 300, 450, 600}));
  EXPECT_EQ(folder.field_steps("grains"),
            (std::vector<std::uint64_t>{0, 100, 200, 300, 400, 500, 600}));
  EXPECT_EQ(folder.field_steps("contacts").size(), 7U);
  EXPECT_TRUE(folder.field_steps("surfaces").empty());
  EXPECT_EQ(read_history(folder.history()).rows.size(), 25U);
  EXPECT_EQ(read_file(folder.scene()), scene_text(usual));
  EXPECT_NE(read_file(folder.json()).find("\"status\": \"complete\""), std::string::npos);
  EXPECT_LT(std::abs(report.energy_error), 0.05 * report.energy_turnover);
  for (const auto& [name, content] : files_of(root_ / "a")) {
    EXPECT_FALSE(name.ends_with(".tmp")) << name;
  }
}

TEST_F(RunTest, ResumedRunsEqualUninterruptedOnesToTheLastByte) {
  run(scene_text(usual), {.folder = root_ / "whole"});
  RunReport report = run_until(137, scene_text(usual), {.folder = root_ / "parts"});
  EXPECT_EQ(report.end, RunEnd::interrupted);
  EXPECT_EQ(report.progress.step, 137U);
  EXPECT_EQ(RunFolder{root_ / "parts"}.checkpoint_steps(), (std::vector<std::uint64_t>{137}));
  report = run_until(425, scene_text(usual), {.folder = root_ / "parts", .resume = true});
  EXPECT_EQ(report.progress.first_step, 137U);
  report = run(scene_text(usual), {.folder = root_ / "parts", .resume = true});
  EXPECT_EQ(report.end, RunEnd::complete);
  EXPECT_EQ(report.progress.first_step, 425U);
  expect_equal_folders(root_ / "whole", root_ / "parts");
  EXPECT_TRUE(compare_runs(RunFolder{root_ / "whole"}, RunFolder{root_ / "parts"}).identical());
}

TEST_F(RunTest, ThreadsDoNotChangeAByte) {
  for (const int threads : {1, 2, 4}) {
    set_thread_count(threads);
    run(scene_text(usual), {.folder = root_ / std::to_string(threads), .steps = 300});
  }
  expect_equal_folders(root_ / "1", root_ / "2");
  expect_equal_folders(root_ / "1", root_ / "4");
}

TEST_F(RunTest, ARunOfOddLengthIsExtendedWithoutATrace) {
  run(scene_text(usual), {.folder = root_ / "whole", .steps = 333});
  run(scene_text(usual), {.folder = root_ / "parts", .steps = 190});
  run(scene_text(usual), {.folder = root_ / "parts", .resume = true, .steps = 333});
  expect_equal_folders(root_ / "whole", root_ / "parts");
}

TEST_F(RunTest, ResumingACompleteRunChangesNothing) {
  run(scene_text(usual), {.folder = root_ / "a", .steps = 130});
  const RunFolder folder{root_ / "a"};
  const auto before = files_of(root_ / "a");
  const std::string record = read_file(folder.json());  // times of the session that did the work
  const std::string performance = read_file(folder.performance());
  const RunReport report =
      run(scene_text(usual), {.folder = root_ / "a", .resume = true, .steps = 130});
  EXPECT_EQ(report.end, RunEnd::nothing_to_do);
  EXPECT_EQ(files_of(root_ / "a"), before);
  EXPECT_EQ(read_file(folder.json()), record);
  EXPECT_EQ(read_file(folder.performance()), performance);

  // One that was killed after its last checkpoint is not said to be running for ever.
  std::string running = record;
  running.replace(running.find("complete"), 8, "running");
  write_file(folder.json(), running);
  (void)run(scene_text(usual), {.folder = root_ / "a", .resume = true, .steps = 130});
  EXPECT_NE(read_file(folder.json()).find("\"status\": \"complete\""), std::string::npos);
}

TEST_F(RunTest, SafetyCheckpointsGiveWay) {
  run(scene_text(usual), {.folder = root_ / "a", .steps = 60, .safety_interval = 0});
  run(scene_text(usual), {.folder = root_ / "b", .steps = 60, .safety_interval = 1e-9});
  expect_equal_folders(root_ / "a", root_ / "b");
}

TEST_F(RunTest, ADamagedCheckpointIsSetAsideForAnEarlierOne) {
  run(scene_text(usual), {.folder = root_ / "whole"});
  run_until(320, scene_text(usual), {.folder = root_ / "parts"});
  const RunFolder folder{root_ / "parts"};
  ASSERT_EQ(folder.checkpoint_steps(), (std::vector<std::uint64_t>{150, 300, 320}));
  {
    std::fstream file{folder.checkpoint(320), std::ios::in | std::ios::out | std::ios::binary};
    file.seekp(3000);
    file.put('!');
  }
  std::string notes;
  RunHooks hooks;
  hooks.note = [&](const std::string& text) { notes += text + '\n'; };
  const RunReport report =
      run(scene_text(usual), {.folder = root_ / "parts", .resume = true}, hooks);
  EXPECT_EQ(report.progress.first_step, 300U);
  EXPECT_NE(notes.find("damaged"), std::string::npos) << notes;
  const std::filesystem::path aside = folder.checkpoint(320).string() + ".damaged";
  EXPECT_TRUE(std::filesystem::remove(aside));
  expect_equal_folders(root_ / "whole", root_ / "parts");
}

TEST_F(RunTest, AFolderInUseIsNotTouched) {
  std::filesystem::create_directories(root_ / "mine");
  std::ofstream{root_ / "mine" / "thesis.tex"} << "text";
  const RunOptions mine{.folder = root_ / "mine", .overwrite = true, .steps = 5};
  EXPECT_NE(message_of([&] { run(scene_text(usual), mine); }).find("not of a run"),
            std::string::npos);
  EXPECT_EQ(files_of(root_ / "mine").size(), 1U);

  run(scene_text(usual), {.folder = root_ / "a", .steps = 5});
  const auto before = files_of(root_ / "a");
  EXPECT_NE(message_of([&] {
              run(scene_text(usual), {.folder = root_ / "a", .steps = 5});
            }).find("--resume"),
            std::string::npos);
  EXPECT_EQ(files_of(root_ / "a"), before);
  run(scene_text(usual), {.folder = root_ / "a", .overwrite = true, .steps = 7});
  EXPECT_EQ(RunFolder{root_ / "a"}.checkpoint_steps(), (std::vector<std::uint64_t>{7}));
}

TEST_F(RunTest, OnlyTheSameRunIsResumed) {
  const std::string text = scene_text(usual);
  run(text, {.folder = root_ / "a", .steps = 50});
  const RunOptions resume{.folder = root_ / "a", .resume = true, .steps = 60};
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    other.replace(other.find(from), from.size(), to);
    return message_of([&] { run(other, resume); });
  };
  EXPECT_NE(changed("friction = 0.4", "friction = 0.41").find("material.friction was 0.4"),
            std::string::npos);
  EXPECT_NE(changed("seed = 5", "seed = 6").find("seed was 5 and now is 6"), std::string::npos);
  EXPECT_NE(changed("history_interval = 25", "history_interval = 50").find("history_interval"),
            std::string::npos);
  EXPECT_NE(changed("name = \"plate\"", "name = \"lid\"").find("wall.name"), std::string::npos);
  EXPECT_EQ(changed("checkpoint_interval = 150", "checkpoint_interval = 10"), "no error");
  save_library(root_ / "grains.h5",
               {testing::bumpy_grain(0.001, 121, 16), testing::sphere(0.001, 100, 16)});
  EXPECT_NE(changed("5", "5").find("shapes have changed"), std::string::npos);
}

TEST_F(RunTest, ABlowUpNamesGrainStepAndCheckpoint) {
  const std::string text =
      scene_text("[time]\nsteps = 5000\nstep = 0.004\n[output]\ncheckpoint_interval = 1\n");
  std::string message;
  try {
    run(text, {.folder = root_ / "a"});
    FAIL() << "did not blow up";
  } catch (const RunFailure& failure) {
    message = failure.what();
  }
  EXPECT_EQ(message.find("grain "), 0U) << message;
  EXPECT_NE(message.find("step "), std::string::npos) << message;
  EXPECT_NE(message.find("The last checkpoint is"), std::string::npos) << message;
  EXPECT_NE(read_file(RunFolder{root_ / "a"}.json()).find("\"status\": \"failed\""),
            std::string::npos);
}

TEST_F(RunTest, StopsAtRestWhereAnUninterruptedRunDoes) {
  const std::string text = scene_text(
      "[time]\nsteps = 100000\nstop_at_unbalanced_ratio = 0.8\n[output]\nhistory_interval = 20\n");
  const RunReport whole = run(text, {.folder = root_ / "whole"});
  EXPECT_EQ(whole.end, RunEnd::at_rest);
  EXPECT_LT(whole.last.unbalanced_ratio, 0.8);
  EXPECT_EQ(whole.progress.step % 20, 0U);
  run_until(whole.progress.step - 7, text, {.folder = root_ / "parts"});
  const RunReport parts = run(text, {.folder = root_ / "parts", .resume = true});
  EXPECT_EQ(parts.end, RunEnd::at_rest);
  expect_equal_folders(root_ / "whole", root_ / "parts");
  EXPECT_EQ(run(text, {.folder = root_ / "parts", .resume = true}).end, RunEnd::nothing_to_do);
  expect_equal_folders(root_ / "whole", root_ / "parts");
}

/// The first grains that come down bounce: their contacts carry no force, or a large one, at some
/// step, while all others fall. That is no rest.
TEST_F(RunTest, AReboundInMidFallIsNoRest) {
  std::string text = scene_text(
      "[time]\nsteps = 40000\nstop_at_unbalanced_ratio = 0.02\n[output]\nhistory_interval = 1\n");
  text = with(text, "random_acceleration = 3\nrandom_interval = 7\n");
  text = with(text, "motion = { velocity = [0, 0, -0.4] }\n");
  const RunReport report = run(text, {.folder = root_ / "whole"});
  EXPECT_EQ(report.end, RunEnd::at_rest);
  EXPECT_TRUE(report.verdict.valid()) << verdict_text(report.verdict);
  EXPECT_GE(report.last.carried_share, 0.9);
  EXPECT_LE(report.last.kinetic_ratio, 0.02);
  // Rest has lasted: it was seen at one step after another.
  const std::vector<double> ratio = column("unbalanced_ratio");
  ASSERT_GT(ratio.size(), 300U);
  for (std::size_t n = ratio.size() - 300; n < ratio.size(); ++n) EXPECT_LT(ratio[n], 0.02);
  // Contacts without a force, or none, make no small ratio.
  EXPECT_EQ(ratio.front(), std::numeric_limits<double>::infinity());

  const RunReport fall = run(text, {.folder = root_ / "fall", .steps = 200});
  ASSERT_FALSE(fall.verdict.valid());
  EXPECT_EQ(fall.verdict.reasons[0].code, "not_at_rest");
  const RunVerdict later = verdict_of(RunFolder{root_ / "fall"});
  EXPECT_NE(verdict_text(later).find("not at rest at step 200"), std::string::npos);
  EXPECT_EQ(
      run(text, {.folder = root_ / "fall", .resume = true, .steps = 200}).verdict.reasons[0].code,
      "not_at_rest");
}

TEST_F(RunTest, TwoProcessesDoNotShareAFolder) {
  std::filesystem::create_directories(root_ / "a");
  const FolderLock lock{root_ / "a"};
  EXPECT_NE(message_of([&] {
              run(scene_text(usual), {.folder = root_ / "a", .steps = 5});
            }).find("another process"),
            std::string::npos);
}

}  // namespace
}  // namespace reckon
