// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "reckon/output/history.hpp"
#include "reckon/results/stage_report.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

class StagedRunTest : public testing::RunSceneTest {
 protected:
  [[nodiscard]] std::vector<std::string> faults_of(const std::string& tables) const {
    SceneReading reading = read_scene_text(staged(tables), root_);
    if (reading.faults.empty()) (void)load_scene(reading);
    std::vector<std::string> found;
    for (const SceneFault& fault : reading.faults)
      found.push_back(fault.key + ": " + fault.problem);
    return found;
  }
  [[nodiscard]] static std::vector<std::string> column(const HistoryTable& table,
                                                       const std::string& name) {
    const auto place = std::find(table.header.begin(), table.header.end(), name);
    std::vector<std::string> cells;
    EXPECT_NE(place, table.header.end()) << name;
    for (const auto& row : table.rows) {
      cells.push_back(row[static_cast<std::size_t>(place - table.header.begin())]);
    }
    return cells;
  }
};

TEST_F(StagedRunTest, StagesFollowEachOtherByGoalAndByTime) {
  std::vector<std::string> notes;
  RunHooks hooks;
  hooks.note = [&](const std::string& note) { notes.push_back(note); };
  const RunReport report = run(staged(), {.folder = root_ / "run"}, hooks);
  EXPECT_EQ(report.end, RunEnd::complete);
  const HistoryTable table = read_history(root_ / "run/history.csv");
  const auto stage = column(table, "stage");
  const auto step = column(table, "step");
  EXPECT_TRUE(std::is_sorted(stage.begin(), stage.end()));
  const auto steps_of = [&](const char* number) {
    const auto [first, last] = std::equal_range(stage.begin(), stage.end(), number);
    return std::stoul(step[static_cast<std::size_t>(last - stage.begin()) - 1]) -
           (first == stage.begin()
                ? 0
                : std::stoul(step[static_cast<std::size_t>(first - stage.begin()) - 1]));
  };
  EXPECT_LT(steps_of("1"), 1500U);  // by its goal
  EXPECT_EQ(steps_of("1") % 20, 0U);
  EXPECT_EQ(steps_of("2"), 333U);
  EXPECT_LT(steps_of("3"), 1000U);
  // Strains are counted anew by each stage; the third pulls.
  EXPECT_LT(std::stod(column(table, "strain_z").back()), -0.004);
  const auto is = [](const std::string& wanted) {
    return [wanted](const std::string& note) { return note.find(wanted) != std::string::npos; };
  };
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), is("stage press ended after")));
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), is("stage shear ended after 333 steps")));
  EXPECT_NE(report.stages.find("shear: peak friction angle"), std::string::npos) << report.stages;
}

TEST_F(StagedRunTest, BreaksAnywhereLeaveTheSameFiles) {
  const RunReport whole = run(staged(), {.folder = root_ / "whole"});
  const std::uint64_t end = whole.progress.step;
  const HistoryTable table = read_history(root_ / "whole/history.csv");
  const auto stage = column(table, "stage");
  const auto last_of_first = std::count(stage.begin(), stage.end(), "1") - 1;
  const std::uint64_t boundary =
      std::stoul(column(table, "step")[static_cast<std::size_t>(last_of_first)]);
  for (const std::uint64_t step : {boundary - 7, boundary, boundary + 1, boundary + 340, end - 1}) {
    const auto folder = root_ / ("broken_at_" + std::to_string(step));
    EXPECT_EQ(run_until(step, staged(), {.folder = folder}).end, RunEnd::interrupted);
    EXPECT_EQ(run(staged(), {.folder = folder, .resume = true}).end, RunEnd::complete);
    expect_equal_folders(folder, root_ / "whole");
  }
  EXPECT_EQ(run(staged(), {.folder = root_ / "whole", .resume = true}).end, RunEnd::nothing_to_do);
}

/// A cycle is a path in q and strain that has a sign and one beginning.
TEST_F(StagedRunTest, DeviatorAndStrainOfTheWholeTestHaveASign) {
  (void)run(staged(), {.folder = root_ / "whole"});
  const auto numbers = [&](const char* name) { return RunSceneTest::column(name); };
  const auto stage = numbers("stage");
  const auto strain = numbers("strain_z");
  const auto total = numbers("total_strain_z");
  const auto axial = numbers("axial_strain");
  const auto deviator = numbers("axial_deviator_Pa");
  const auto along = numbers("stress_zz_Pa");
  const auto mean = numbers("mean_stress_Pa");
  double at_start = 0;  // of the stage
  bool has_pull = false;
  for (std::size_t row = 0; row < stage.size(); ++row) {
    if (row > 0 && stage[row] != stage[row - 1]) at_start = total[row - 1];
    EXPECT_NEAR(total[row], at_start + strain[row], 1e-12) << row;
    EXPECT_EQ(axial[row], total[row]) << row;
    EXPECT_NEAR(deviator[row], 1.5 * (along[row] - mean[row]), 1e-9 * mean.back()) << row;
    has_pull = has_pull || deviator[row] < 0;
  }
  EXPECT_GT(total.back(), 0.1);
  EXPECT_TRUE(has_pull);
}

/// Pressed along z alone, the sample pushes on its sides too, less and later.
TEST_F(StagedRunTest, AGoalNamesTheWallThatItMeans) {
  const auto end_of = [&](const std::string& wall) {
    const std::string text =
        std::string{"[[stage]]\nname = 'press'\nsteps = 20000\nuntil = { stress_above = '60 kPa'"} +
        wall +
        " }\ngravity = [0, 0, 0]\ncontrol = [{ wall = 'box.z', strain_rate = 20 }]\n"
        "[output]\nhistory_interval = 20\nsample = true\n";
    std::filesystem::remove_all(root_ / "whole");
    (void)run(staged(text), {.folder = root_ / "whole"});
    return std::pair{RunSceneTest::column("wall_stress_xx_Pa").back(),
                     RunSceneTest::column("axial_strain").back()};
  };
  const auto [side_of_driven, driven] = end_of("");
  const auto [side, late] = end_of(", wall = 'box.x'");
  EXPECT_LT(side_of_driven, 0.8 * side);
  EXPECT_GT(side, 55e3);
  EXPECT_GT(late, driven);
  EXPECT_EQ(end_of(", wall = 'box.z'").second, driven);
}

/// A hundred times the inertia: steps ten times longer, unchanged weights, and the run prints it.
TEST_F(StagedRunTest, DensityScalingKeepsWeightAndLengthensSteps) {
  const std::string plain = scene_text(usual);
  std::string scaled = plain;
  scaled.replace(scaled.find("friction = 0.4"), 14, "friction = 0.4\ndensity_scaling = 100");
  const auto prepared = [&](const std::string& text) {
    SceneReading reading = read(text);
    return prepare(load_scene(reading));
  };
  const PreparedScene one = prepared(plain);
  const PreparedScene hundred = prepared(scaled);
  EXPECT_NEAR(hundred.time_step.step, 10 * one.time_step.step, 1e-12 * one.time_step.step);
  EXPECT_EQ(hundred.setup.density, 100 * one.setup.density);
  EXPECT_NEAR(hundred.setup.density * hundred.setup.body_force.gravity.z,
              one.setup.density * one.setup.body_force.gravity.z, 1e-9);
  std::vector<std::string> notes;
  RunHooks hooks;
  hooks.note = [&](const std::string& note) { notes.push_back(note); };
  (void)run(scaled, {.folder = root_ / "run", .steps = 3}, hooks);
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note == "inertia is scaled: grains move as if 100 times denser";
  }));
}

/// Cement before the shearing stage: it holds and breaks, is in every file, and resumes.
TEST_F(StagedRunTest, BondsAreCountedAndOutliveABreak) {
  std::string text = staged();
  text.replace(text.find("name = \"shear\""), 14, "name = \"shear\"\nbond = true");
  text += "[bond]\ntensile_strength = '40 kPa'\nshear_strength = '40 kPa'\nradius_share = 0.3\n";
  const RunReport whole = run(text, {.folder = root_ / "whole"});
  const HistoryTable table = read_history(root_ / "whole/history.csv");
  const auto stage = column(table, "stage");
  const auto bonds = column(table, "bonds");
  const auto first = std::count(stage.begin(), stage.end(), "1");
  EXPECT_EQ(bonds[static_cast<std::size_t>(first) - 1], "0");
  EXPECT_GT(std::stoi(bonds[static_cast<std::size_t>(first)]), 2);
  EXPECT_GT(std::stoi(column(table, "broken_in_tension").back()) +
                std::stoi(column(table, "broken_in_shear").back()),
            0);
  EXPECT_GT(std::stod(column(table, "fracture_J").back()), 0);
  const std::uint64_t step = whole.progress.step - 900;
  EXPECT_EQ(run_until(step, text, {.folder = root_ / "broken"}).end, RunEnd::interrupted);
  EXPECT_EQ(run(text, {.folder = root_ / "broken", .resume = true}).end, RunEnd::complete);
  expect_equal_folders(root_ / "broken", root_ / "whole");
}

TEST_F(StagedRunTest, AShorterRunGoesOn) {
  (void)run(staged(), {.folder = root_ / "whole"});
  EXPECT_EQ(run(staged(), {.folder = root_ / "short", .steps = 411}).progress.step, 411U);
  EXPECT_EQ(run(staged(), {.folder = root_ / "short", .resume = true}).end, RunEnd::complete);
  expect_equal_folders(root_ / "short", root_ / "whole");
}

TEST_F(StagedRunTest, FaultsOfStagesAreFound) {
  using Faults = std::vector<std::string>;
  const std::string stage = "[[stage]]\nname = 'a'\nsteps = 10\n";
  EXPECT_EQ(faults_of(stage + "control = [{ wall = 'box.q', speed = 1 }]\n"),
            (Faults{"stage[0].control[0].wall: no plane or pair of planes is named \"box.q\""}));
  EXPECT_EQ(
      faults_of(stage + "control = [{ wall = 'box.x', speed = 1 }, { wall = 'box.x+', speed = "
                        "1 }]\n"),
      (Faults{"stage[0].control[1].wall: \"box.x+\" is moved by another control of this stage "
              "already"}));
  EXPECT_EQ(faults_of(stage + "control = [{ wall = 'box.x', stress = 0 }]\n"),
            (Faults{"stage[0].control[0]: needs a `rate_limit`"}));
  EXPECT_EQ(faults_of(stage + "until = { stress_above = 1 }\n"),
            (Faults{"stage[0].until: asks for the stress on walls that are driven, but none is"}));
  EXPECT_EQ(faults_of(stage + "until = { stress_above = 1, wall = 'lid' }\n"),
            (Faults{"stage[0].until.wall: no plane or pair of planes is named \"lid\""}));
  EXPECT_EQ(faults_of(stage + "until = { unbalanced_ratio = 1, wall = 'box.x' }\n"),
            (Faults{"stage[0].until.wall: is of no use without a `strain` or a stress of it"}));
  EXPECT_EQ(
      faults_of(stage + "until = { stress_below = 1 }\ncontrol = [{ wall = 'box.x', speed = 1 }, { "
                        "wall = 'box.y', speed = 1 }]\n"),
      (Faults{"stage[0].until: asks for a stress, but several controls drive something"}));
  EXPECT_EQ(faults_of(stage + "control = [{ wall = 'box.x', speed = 1, gain = 0.5 }]\n"),
            (Faults{"stage[0].control[0].gain: `gain` belongs to `stress`"}));
  EXPECT_EQ(faults_of(stage + "[time]\nsteps = 5\n"),
            (Faults{"time.steps: with [[stage]] tables, only they say when to end: no `duration`, "
                    "`steps` or `stop_at_unbalanced_ratio` here"}));
  EXPECT_EQ(faults_of(stage + "bond = true\n"),
            (Faults{"stage[0].bond: sets cement that the scene does not describe"}));
  EXPECT_EQ(faults_of(stage + "[bond]\ntensile_strength = '1 kPa'\nshear_strength = '1 kPa'\n"),
            (Faults{"bond: is never set"}));
  EXPECT_EQ(
      faults_of(stage + "until = { strain = 0.1 }\n[[wall]]\nname = 'tube'\ncylinder = { point "
                        "= [0, 0, 0], axis = [1, 1, 0], radius = 1 }\n"),
      (Faults{"stage[0].until: needs walls that close off a space, which these do not"}));
}

TEST(StageNote, TellsOfTooLittleSpaceForTheGrains) {
  SampleMeasurement sample;
  sample.enclosed = true;
  sample.void_ratio = 0.7;
  EXPECT_EQ(stage_note("press", 10, true, {}, sample).find("TOO LITTLE SPACE"), std::string::npos);
  sample.void_ratio = -0.7;
  EXPECT_NE(stage_note("press", 10, true, {}, sample).find("void ratio -0.700"), std::string::npos);
  EXPECT_NE(stage_note("press", 10, true, {}, sample).find("TOO LITTLE SPACE"), std::string::npos);
}

}  // namespace
}  // namespace reckon
