// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What --overwrite and --resume do to files that are the user's, and to what a full disk has left.
#include "reckon/output/run_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/results/run_record.hpp"
#include "reckon/results/stage_report.hpp"
#include "reckon/text/csv_text.hpp"
#include "reckon/text/json_writer.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

class RunFolderTest : public testing::RunSceneTest {
 protected:
  [[nodiscard]] RunFolder folder() const { return RunFolder{root_ / "a"}; }
  [[nodiscard]] std::string notes_of(const RunOptions& options) const {
    std::string notes;
    RunHooks hooks;
    hooks.note = [&](const std::string& text) { notes += text + '\n'; };
    run(scene_text(usual), options, hooks);
    return notes;
  }
};

TEST_F(RunFolderTest, AUsersFilesAreNeverRemoved) {
  run(scene_text(usual), {.folder = root_ / "a", .steps = 100});
  std::filesystem::create_directories(folder().paraview() / "shapes");
  for (const char* mine :
       {"paraview/my_figure.png", "paraview/shapes/my.vtp", "draft.tmp", "notes.txt.12-3.tmp",
        "fields/grains_old.vtp.1-2.tmp", "checkpoints/best.h5", "checkpoints/x.tmp"}) {
    write_file(folder().root() / mine, "mine");
  }
  const std::filesystem::path left = folder().root() / "run.json.4711-0.tmp";
  write_file(left, "of a killed run");
  write_file(folder().root() / "checkpoints/step_0000000100.h5.4711-1.tmp", "of a killed run");
  for (const bool resume : {true, false}) {
    run(scene_text(usual),
        {.folder = root_ / "a", .resume = resume, .overwrite = !resume, .steps = 150});
    for (const char* mine :
         {"paraview/my_figure.png", "paraview/shapes/my.vtp", "draft.tmp", "notes.txt.12-3.tmp",
          "fields/grains_old.vtp.1-2.tmp", "checkpoints/best.h5", "checkpoints/x.tmp"}) {
      EXPECT_TRUE(std::filesystem::exists(folder().root() / mine)) << mine;
    }
    EXPECT_FALSE(std::filesystem::exists(left));
  }
  EXPECT_FALSE(
      std::filesystem::exists(folder().root() / "checkpoints/step_0000000100.h5.4711-1.tmp"));
}

TEST_F(RunFolderTest, WhatALinkPointsToIsNotRemoved) {
  run(scene_text(usual), {.folder = root_ / "a", .steps = 300});
  for (const char* name : {"fields", "checkpoints"}) {
    std::filesystem::rename(folder().root() / name, root_ / ("my_" + std::string{name}));
    std::filesystem::create_directory_symlink(root_ / ("my_" + std::string{name}),
                                              folder().root() / name);
  }
  const auto before = files_of(root_ / "my_fields");
  const auto states = files_of(root_ / "my_checkpoints");
  ASSERT_FALSE(before.empty());
  run(scene_text(usual), {.folder = root_ / "a", .overwrite = true, .steps = 100});
  EXPECT_EQ(files_of(root_ / "my_fields"), before);
  EXPECT_EQ(files_of(root_ / "my_checkpoints"), states);
  EXPECT_FALSE(std::filesystem::is_symlink(folder().root() / "fields"));
}

TEST_F(RunFolderTest, AResumeNamesTheRowsThatAreLost) {
  run_until(320, scene_text(usual), {.folder = root_ / "a"});
  std::string history = read_file(folder().history());
  for (const char* step : {"\n50,", "\n75,"}) {
    const std::size_t at = history.find(step) + 1;
    history.erase(at, history.find('\n', at) + 1 - at);
  }
  write_file(folder().history(), history);
  const std::string notes = notes_of({.folder = root_ / "a", .resume = true, .steps = 400});
  EXPECT_NE(notes.find("history.csv lacks 2 rows from before the checkpoint (steps 50, 75)"),
            std::string::npos)
      << notes;
  std::filesystem::remove(folder().history());
  const std::string all = notes_of({.folder = root_ / "a", .resume = true, .steps = 500});
  EXPECT_NE(all.find("history.csv lacks 17 rows"), std::string::npos) << all;
  EXPECT_EQ(read_history(folder().history()).rows.size(), 4U);  // 425 to 500
}

TEST_F(RunFolderTest, WithoutAGoodCheckpointNothingIsThrownAway) {
  run(scene_text(usual), {.folder = root_ / "a", .steps = 150});
  for (const std::uint64_t step : folder().checkpoint_steps()) {
    write_file(folder().checkpoint(step), "damaged");
  }
  const auto rows = read_file(folder().history());
  EXPECT_THROW(run(scene_text(usual), {.folder = root_ / "a", .resume = true}), Error);
  EXPECT_EQ(read_file(folder().history()), rows);
}

TEST_F(RunFolderTest, ARecordIsWrittenOverWhereThereIsNoRoomForANewOne) {
  const std::filesystem::path file = root_ / "run.json";
  overwrite_run_record(file, {.status = "failed"});
  EXPECT_FALSE(std::filesystem::exists(file)) << "there was none";
  write_run_record(file, {.status = "running", .message = std::string(500, 'x')});
  overwrite_run_record(file, {.status = "failed"});
  EXPECT_EQ(recorded_status(file), "failed");
  EXPECT_TRUE(read_file(file).ends_with("}\n"));
}

TEST_F(RunFolderTest, AHistoryWithoutAColumnSaysWhich) {
  run(staged(), {.folder = root_ / "a"});
  const SceneConfig scene = read(staged()).config;
  HistoryTable table = read_history(folder().history());
  ASSERT_FALSE(stage_findings(scene, table).empty());
  for (std::string& name : table.header) {
    const std::string good = name;
    if (good != "axial_strain" && good != "void_ratio" && good != "inertial_number") continue;
    name = "other";
    try {
      (void)stage_findings(scene, table);
      ADD_FAILURE() << good << " is not missed";
    } catch (const Error& error) {
      EXPECT_NE(std::string{error.what()}.find("no column \"" + good + '"'), std::string::npos)
          << error.what();
    }
    name = good;
  }
}

TEST(CsvText, KeepsNamesInOneCellAndNeverMakesAFormula) {
  EXPECT_EQ(csv_text("grain_7"), "grain_7");
  EXPECT_EQ(csv_text("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_text("the \"big\" one"), "\"the \"\"big\"\" one\"");
  EXPECT_EQ(csv_text("two\nlines"), "\"two\nlines\"");
  EXPECT_EQ(csv_text("=1+1"), "'=1+1");
  EXPECT_EQ(csv_text("@a,b"), "\"'@a,b\"");
}

TEST(CommaSeparated, HasOnePartMoreThanCommas) {
  using Parts = std::vector<std::string_view>;
  EXPECT_EQ(comma_separated(""), Parts{""});
  EXPECT_EQ(comma_separated("1 mm"), Parts{"1 mm"});
  EXPECT_EQ(comma_separated("a,,b,"), (Parts{"a", "", "b", ""}));
}

TEST(JsonText, IsUtf8Always) {
  EXPECT_EQ(json_text("d\xe9j\xe0"), "\"d\xef\xbf\xbdj\xef\xbf\xbd\"");
  EXPECT_EQ(json_text("\x1b[0m"), "\"\\u001b[0m\"");
}

}  // namespace
}  // namespace reckon
