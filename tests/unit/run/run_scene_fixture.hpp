// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include "reckon/avatar/library_file.hpp"
#include "reckon/core/file.hpp"
#include "reckon/output/history.hpp"
#include "reckon/output/run_folder.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/run/run.hpp"
#include "reckon/scene/scene_loader.hpp"
#include "support/test_path.hpp"
#include "support/test_shapes.hpp"

namespace reckon::testing {

/// A folder with a small shape library and a scene in which 24 uneven grains fall into a box that
/// one moving wall squeezes: all kinds of state are in use.
class RunSceneTest : public ::testing::Test {
 protected:
  void SetUp() override {
    set_thread_count(1);  // small scenes on a busy machine: threads would mostly wait
    root_ = test_path();
    std::filesystem::remove_all(root_);
    std::filesystem::create_directories(root_);
    save_library(root_ / "grains.h5", {bumpy_grain(0.001, 120, 16), sphere(0.001, 100, 16)});
  }
  void TearDown() override {
    if (!HasFailure()) std::filesystem::remove_all(root_);
  }

  /// `[time]` and `[output]` come from the caller.
  [[nodiscard]] static std::string scene_text(const std::string& more) {
    return R"(title = "Squeezed grains"
seed = 5
[material]
friction = 0.4
[contact]
normal_stiffness = "2e9 N/m^3"
restitution = 0.5
[body]
gravity = [0, 0, -9.81]
damping = 2
random_acceleration = 3
random_interval = 7
[[grains]]
library = "grains.h5"
[grains.fill]
count = 24
velocity = [0, 0, -0.6]
box = { low = [0, 0, 0], high = ["7 mm", "7 mm", "20 mm"] }
[[wall]]
name = "box"
box = { low = [0, 0, 0], high = ["7 mm", "7 mm", "20 mm"], open_top = true }
[[wall]]
name = "plate"
plane = { point = [0, 0, "20 mm"], normal = [0, 0, -1] }
motion = { velocity = [0, 0, -0.4] }
)" + more;
  }
  static constexpr const char* usual =
      "[time]\nsteps = 600\n[output]\nhistory_interval = 25\nfields_interval = 100\n"
      "checkpoint_interval = 150\n";

  /// The same grains in a box with a lid, pressed, sheared and pulled in three stages.
  static constexpr const char* stages = R"(
[[stage]]
name = "press"
steps = 1500
until = { stress_error = 0.5, unbalanced_ratio = 0.9 }
friction = 0.1
gravity = [0, 0, 0]
damping = 200
history_interval = 20
control = [{ wall = "box", stress = "200 kPa", rate_limit = 150 }]
[[stage]]
name = "shear"
steps = 333
fields_interval = 50
control = [{ wall = "box.x", stress = "200 kPa" }, { wall = "box.z", strain_rate = 40 }]
[[stage]]
name = "back"
steps = 1000
until = { strain = 0.004 }
control = [{ wall = "box.z", speed = "-0.2 m/s" }]
[output]
history_interval = 25
checkpoint_interval = 150
sample = true
)";
  static std::string staged(const std::string& tables = stages) {
    std::string text = scene_text("");
    for (const auto& [from, to] : {std::pair<std::string, std::string>{", open_top = true", ""},
                                   {"[[wall]]\nname = \"plate\"\nplane = { point = [0, 0, \"20 "
                                    "mm\"], normal = [0, 0, -1] }\n"
                                    "motion = { velocity = [0, 0, -0.4] }\n",
                                    ""}}) {
      text.replace(text.find(from), from.size(), to);
    }
    return text + tables;
  }

  [[nodiscard]] SceneReading read(const std::string& text) const {
    SceneReading reading = read_scene_text(text, root_);
    for (const SceneFault& fault : reading.faults) ADD_FAILURE() << describe(fault, "scene");
    return reading;
  }

  RunReport run(const std::string& text, RunOptions options, const RunHooks& hooks = {}) const {
    SceneReading reading = read(text);
    const LoadedScene scene = load_scene(reading);
    for (const SceneFault& fault : reading.faults) ADD_FAILURE() << describe(fault, "scene");
    return run_scene(reading, scene, options, hooks);
  }
  /// Runs until `step`, then stops as a signal would stop it.
  RunReport run_until(std::uint64_t step, const std::string& text, RunOptions options) const {
    std::uint64_t at = 0;
    RunHooks hooks;
    // Called before `progressed` for the same step.
    hooks.stop_requested = [&] { return at + 1 >= step; };
    hooks.progressed = [&](const RunProgress& progress) { at = progress.step; };
    return run(text, std::move(options), hooks);
  }

  /// All files of a run by name, except those that depend on date and speed.
  [[nodiscard]] static std::map<std::string, std::string> files_of(
      const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator{folder}) {
      if (!entry.is_regular_file()) continue;
      const std::string name = entry.path().lexically_relative(folder).string();
      if (name == "run.log" || name == "run.json" || name == "performance.json") continue;
      files[name] = read_file(entry.path());
    }
    return files;
  }
  static void expect_equal_folders(const std::filesystem::path& a, const std::filesystem::path& b) {
    const auto first = files_of(a);
    const auto second = files_of(b);
    for (const auto& [name, content] : first) {
      const auto other = second.find(name);
      ASSERT_NE(other, second.end()) << name << " is only in " << a;
      EXPECT_TRUE(other->second == content) << name << " differs";
    }
    for (const auto& [name, content] : second) {
      EXPECT_TRUE(first.contains(name)) << name << " is only in " << b;
    }
  }

  /// What reading and loading complain of, sorted: "KEY: PROBLEM".
  [[nodiscard]] std::vector<std::string> faults_of(const std::string& text) const {
    SceneReading reading = read_scene_text(text, root_);
    if (reading.faults.empty()) (void)load_scene(reading);
    std::vector<std::string> found;
    for (const SceneFault& fault : reading.faults) {
      found.push_back(fault.key + ": " + fault.problem);
    }
    std::sort(found.begin(), found.end());
    return found;
  }
  static std::string with(std::string text, const std::string& part,
                          const std::string& instead = "") {
    text.replace(text.find(part), part.size(), instead);
    return text;
  }
  /// Of the history of the run in the folder `whole`.
  [[nodiscard]] std::vector<double> column(const std::string& name) const {
    const HistoryTable table = read_history(root_ / "whole/history.csv");
    const auto place = std::find(table.header.begin(), table.header.end(), name);
    std::vector<double> cells;
    EXPECT_NE(place, table.header.end()) << name;
    for (const auto& row : table.rows) {
      cells.push_back(std::stod(row[static_cast<std::size_t>(place - table.header.begin())]));
    }
    return cells;
  }

  std::filesystem::path root_;
};

}  // namespace reckon::testing
