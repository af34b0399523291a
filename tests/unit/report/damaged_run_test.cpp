// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a page and an analysis make of a run that is damaged, or whose files are not its own.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/report/page.hpp"
#include "reckon/report/paraview_state.hpp"
#include "reckon/report/run_shapes.hpp"
#include "reckon/results/run_analysis.hpp"
#include "reckon/results/saved_fields.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

class DamagedRun : public testing::RunSceneTest {
 protected:
  void SetUp() override {
    RunSceneTest::SetUp();
    run(scene_text(usual), {.folder = root_ / "a", .steps = 300});
  }
  [[nodiscard]] RunFolder folder() const { return RunFolder{root_ / "a"}; }
  [[nodiscard]] std::filesystem::path grains_at(std::uint64_t step) const {
    return folder().root() / RunFolder::field_name("grains", step);
  }
  /// Where the numbers of an array of a .vtp file begin.
  static std::size_t place_of(const std::string& bytes, const std::string& name) {
    const std::size_t tag = bytes.find("Name=\"" + name + '"');
    const std::size_t offset = bytes.find("offset=\"", tag) + 8;
    const std::string opening = "<AppendedData encoding=\"raw\">\n_";
    return bytes.find(opening) + opening.size() + std::stoull(bytes.substr(offset)) + 8;
  }
  template <class Act>
  static std::string error_of(Act&& act) {
    try {
      act();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
};

TEST_F(DamagedRun, OneDamagedFileLeavesTheOtherTimes) {
  write_file(grains_at(200), read_file(grains_at(200)).substr(0, 400));
  const RunAnalysis done = analyse_run(folder(), {});
  ASSERT_EQ(done.strains.size(), 2U);
  EXPECT_EQ(done.strains[0].step, 100U);
  EXPECT_EQ(done.strains[1].step, 300U);
  ASSERT_EQ(done.left_out.size(), 1U);
  EXPECT_NE(done.left_out[0].find("grains_0000000200.vtp"), std::string::npos);
  if (viewer_page().empty()) GTEST_SKIP() << "built without the page: no Node.js, or no network";
  std::string notes;
  const std::vector<RunFolder> runs{folder()};
  const std::string page =
      report_page(runs, {}, {}, [&](const std::string& note) { notes += note; });
  EXPECT_NE(notes.find("grains_0000000200.vtp"), std::string::npos) << notes;
  EXPECT_NE(page.find("data-piece=\"0/frame/300\""), std::string::npos);
  EXPECT_EQ(page.find("data-piece=\"0/frame/200\""), std::string::npos);
}

TEST_F(DamagedRun, TheFirstSavedTimeMayBeTheDamagedOne) {
  write_file(grains_at(0), "");
  const RunAnalysis done = analyse_run(folder(), {});
  EXPECT_EQ(done.from, 100U);
  EXPECT_EQ(done.left_out.size(), 1U);
  EXPECT_EQ(grains_by_shape(folder()).size(), 2U);
  EXPECT_THROW((void)analyse_run(folder(), {.from = 0}), Error) << "another step was not asked for";
}

TEST_F(DamagedRun, AWrongShapeNumberTakesNoMemory) {
  std::string bytes = read_file(grains_at(0));
  const std::uint32_t wrong = 4'000'000'000U;
  std::memcpy(bytes.data() + place_of(bytes, "shape"), &wrong, sizeof wrong);
  write_file(grains_at(0), bytes);
  ASSERT_EQ(read_fields(folder(), 0).grains[0].shape, ShapeId{wrong});
  EXPECT_EQ(grains_by_shape(folder()).size(), 3U);  // a list by number would take 32 GB
  RunPieces pieces{folder(), {}};
  EXPECT_FALSE(pieces.head().empty());
  const std::string error = error_of([&] { (void)pieces.frame(0); });
  EXPECT_NE(error.find("shape 4000000000 of 2"), std::string::npos) << error;
}

TEST_F(DamagedRun, GarbageIsNoScene) {
  write_file(folder().resolved(), "garbage \x01 {{{");
  EXPECT_NE(error_of([&] { (void)scene_of_run(folder()); }).find("scene_resolved.toml:1:"),
            std::string::npos);
  write_file(folder().resolved(), "title = 'no more than a title'");
  EXPECT_THROW((void)scene_of_run(folder()), Error);
  EXPECT_THROW((void)RunPieces(folder(), {}).head(), Error);
}

TEST_F(DamagedRun, NeitherPipesNorLinksOutOfTheFolderAreRead) {
  write_file(root_ / "secret.txt", "a key that is nobody's business");
  const auto replaced = [&](const std::filesystem::path& file, auto&& make) {
    const std::filesystem::path kept = file.string() + ".kept";
    std::filesystem::rename(file, kept);
    make(file);
    const std::string error = error_of([&] {
      RunPieces pieces{folder(), {}};
      EXPECT_EQ(pieces.head().find("a key"), std::string::npos);
      (void)pieces.frame(300);
    });
    EXPECT_NE(error.find(file.filename().string()), std::string::npos) << file << error;
    std::filesystem::remove(file);
    std::filesystem::rename(kept, file);
  };
  for (const auto& file : {folder().scene(), folder().log(), folder().json(), folder().resolved(),
                           folder().history(), folder().performance(), grains_at(300)}) {
    replaced(file, [](const auto& name) { EXPECT_EQ(::mkfifo(name.c_str(), 0600), 0); });
    replaced(file, [&](const auto& name) {
      std::filesystem::create_symlink(root_ / "secret.txt", name);
    });
    replaced(file, [](const auto& name) { std::filesystem::create_symlink("/dev/zero", name); });
    replaced(file, [](const auto& name) { std::filesystem::create_symlink("nowhere", name); });
  }
  // A link inside the folder, and folders on another disk, are the user's way to keep files.
  std::filesystem::rename(folder().log(), folder().root() / "kept.log");
  std::filesystem::create_symlink("kept.log", folder().log());
  std::filesystem::rename(folder().root() / "fields", root_ / "other_disk");
  std::filesystem::create_directory_symlink(root_ / "other_disk", folder().root() / "fields");
  RunPieces pieces{folder(), {}};
  EXPECT_FALSE(pieces.head().empty());
  EXPECT_FALSE(pieces.frame(300).empty());
}

TEST_F(DamagedRun, AStateForParaViewLeavesAUsersFiles) {
  std::filesystem::create_directories(folder().paraview() / "shapes");
  write_file(folder().paraview() / "my_figure.png", "mine");
  write_file(folder().paraview() / "shapes" / "mine.vtp", "mine");
  for (int times = 0; times < 2; ++times) static_cast<void>(write_paraview_state(folder()));
  EXPECT_TRUE(std::filesystem::exists(folder().paraview() / "state.py"));
  EXPECT_TRUE(std::filesystem::exists(folder().paraview() / "my_figure.png"));
  EXPECT_TRUE(std::filesystem::exists(folder().paraview() / "shapes" / "mine.vtp"));
}

TEST_F(DamagedRun, AStateForParaViewIsPythonWhateverTheFolderIsCalled) {
  const std::filesystem::path odd = root_ / "it's\n\"b\\c\"\xff";
  std::filesystem::copy(folder().root(), odd, std::filesystem::copy_options::recursive);
  const std::string script = read_file(write_paraview_state(RunFolder{odd}).script);
  const std::size_t at = script.find("os.fsdecode(b\"");
  ASSERT_NE(at, std::string::npos);
  const std::string line = script.substr(at, script.find('\n', at) - at);
  EXPECT_TRUE(line.ends_with("it's\\x0a\\x22b\\x5cc\\x22\\xff\")")) << line;
}

}  // namespace
}  // namespace reckon
