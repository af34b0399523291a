// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "reckon/core/peak_memory.hpp"
#include "reckon/core/seal.hpp"
#include "reckon/run/run_plan.hpp"
#include "reckon/simulation/time_step.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

using Texts = std::vector<std::string>;

/// What is wrong with where grains stand, how fast things move, and how far apart they are.
class StartCheckTest : public testing::RunSceneTest {
 protected:
  /// Grains of 1 mm radius, one wall, and a time step of about 1e-5 s.
  static std::string scene(const std::string& grains, const std::string& more = "") {
    return R"(
[contact]
normal_stiffness = "2e9 N/m^3"
restitution = 0.5
[[grains]]
library = "grains.h5"
)" + grains +
           "\n[time]\nsteps = 10\n" + more;
  }
  static std::string places(const std::string& list) { return "place = [" + list + "]"; }
  static constexpr const char* relaxed = "restitution = 0.5\nallow_inside = true";

  [[nodiscard]] Texts warnings_of(const std::string& text) const {
    SceneReading reading = read(text);
    const LoadedScene loaded = load_scene(reading);
    for (const SceneFault& fault : reading.faults) ADD_FAILURE() << describe(fault, "scene");
    return loaded.warnings;
  }
  void write_poses(const Texts& rows) const {
    std::ofstream file{root_ / "poses.csv"};
    file << "# shape,x_m,y_m,z_m,qw,qx,qy,qz\n";
    for (const std::string& row : rows) file << row << '\n';
  }
  static void expect_parts(const std::string& text, const Texts& parts) {
    for (const std::string& part : parts) {
      EXPECT_NE(text.find(part), std::string::npos) << "\"" << part << "\" in: " << text;
    }
  }
};

TEST_F(StartCheckTest, SaysWhichGrainIsInsideWhich) {
  const auto faults = faults_of(scene(places(
      R"({position=[0,0,0], shape="bumpy"}, {position=[0.01,0,0]}, {position=["50 um",0,0], shape="bumpy"})")));
  ASSERT_EQ(faults.size(), 1U);
  expect_parts(faults[0], {"grains[0].place[2]: grain 2 (grains[0].place[2]) is inside grain 0 "
                           "(grains[0].place[0])"});
}

TEST_F(StartCheckTest, RunsWhenAllowedAndSaysSo) {
  const std::string text = with(scene(places(R"({position=[0,0,0]}, {position=["0.5 mm",0,0]})")),
                                "restitution = 0.5", relaxed);
  const Texts warnings = warnings_of(text);
  ASSERT_EQ(warnings.size(), 1U);
  expect_parts(warnings[0], {"grain 1", "is inside grain 0"});
  Texts notes;
  RunHooks hooks;
  hooks.note = [&](const std::string& note) { notes.push_back(note); };
  (void)run(text, {.folder = root_ / "run"}, hooks);
  EXPECT_EQ(std::count(notes.begin(), notes.end(), "WARNING: " + warnings[0]), 1);
  SceneReading reading = read(text);
  const RunPlan plan = plan_run(load_scene(reading), 0);
  expect_parts(plan_text(plan), {"WARNING      grain 1"});
  expect_parts(plan_json(plan), {"\"warnings\": [\n    \"grain 1"});
}

TEST_F(StartCheckTest, ImagesAndWallsCount) {
  const std::string cell = "[cell]\nlow = [0,0,0]\nhigh = [0.02,0.02,0.02]\n";
  const std::string apart =
      scene(places("{position=[0.0002,0.01,0.01]}, {position=[0.0198,0.01,0.01]}"));
  EXPECT_EQ(faults_of(apart), Texts{});
  const auto across = faults_of(apart + cell);
  ASSERT_EQ(across.size(), 1U);
  expect_parts(across[0], {"grain 1", "is inside grain 0"});

  const std::string floor =
      "[[wall]]\nname = \"floor\"\nplane = { point = [0,0,0], normal = [0,0,1] }\n";
  const std::string beyond =
      scene(places("{position=[0,0,0.002]}, {position=[0.01,0,-0.002]}"), floor);
  const auto faults = faults_of(beyond);
  ASSERT_EQ(faults.size(), 1U);
  expect_parts(faults[0],
               {"grains[0].place[1]: grain 1", "is beyond wall \"floor\"", "0.002 m behind"});
  EXPECT_EQ(warnings_of(with(beyond, "restitution = 0.5", relaxed)).size(), 1U);
}

TEST_F(StartCheckTest, NamesBothRowsOfAPoseThatStandsTwice) {
  write_poses(
      {"0,0,0,0,1,0,0,0", "1,0.01,0,0,1,0,0,0", "0,0.02,0,0,1,0,0,0", "1,0.01,0,0,1,0,0,0"});
  const std::string table = scene("table = { file = \"poses.csv\" }");
  const auto faults = faults_of(table);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0],
            "grains[0].table: grain 3 (row 4 of poses.csv) stands exactly where grain 1 (row 2 of "
            "poses.csv) stands");
  // No contact parts them, so that is not allowed either.
  EXPECT_EQ(faults_of(with(table, "restitution = 0.5", relaxed)), faults);
}

TEST_F(StartCheckTest, ThousandsOfCopiesTakeNoMemory) {
  write_poses(Texts(20000, "0,0,0,0,1,0,0,0"));
  const std::string table = scene("table = { file = \"poses.csv\" }");
  const std::uint64_t before = peak_memory();
  const auto faults = faults_of(table);
  EXPECT_LT(peak_memory() - before, 200'000'000U);
  ASSERT_EQ(faults.size(), 1U);
  expect_parts(faults[0], {"grain 1 (row 2 of poses.csv)", "and so do 19998 more"});

  Texts rows;
  for (int n = 0; n < 20000; ++n) rows.push_back(fmt::format("0,{}e-9,0,0,1,0,0,0", n));
  write_poses(rows);
  EXPECT_EQ(faults_of(table).size(), 21U);
  EXPECT_LT(peak_memory() - before, 200'000'000U);
}

TEST_F(StartCheckTest, CoordinatesBeyondDoublePrecisionAreRefused) {
  const auto at = [](const char* x) {
    return scene(fmt::format(
        "place = [{{position=[{0},0,0], shape=\"sphere\"}}, {{position=[{0},0.003,0]}}]", x));
  };
  EXPECT_EQ(faults_of(at("1e3")), Texts{});
  EXPECT_EQ(warnings_of(at("1e3")), Texts{});
  const Texts coarse = warnings_of(at("1e8"));
  ASSERT_EQ(coarse.size(), 1U);
  expect_parts(coarse[0], {"grain 0 at 1e+08 m is rounded to 2.2e-05 of"});
  const auto faults = faults_of(at("1e15"));
  ASSERT_EQ(faults.size(), 1U);
  expect_parts(faults[0], {"grains: grain 0 at 1e+15 m is beyond double precision"});
  const auto rounded_to_one_pose =
      faults_of(scene(places("{position=[1e15,0,0]}, {position=[1.000000000000000001e15,0,0]}")));
  ASSERT_EQ(rounded_to_one_pose.size(), 1U);
  expect_parts(rounded_to_one_pose[0], {"is beyond double precision"});
  const auto cylinder = faults_of(scene(places("{position=[0,0,0]}"),
                                        "[[wall]]\nname = \"flat\"\ncylinder = { point = "
                                        "[1e15,0,0], axis = [0,0,1], radius = 2e15 }\n"));
  EXPECT_EQ(cylinder.size(), 2U);  // axis and radius
  // A wall at right angles to an axis may be as far as it likes.
  EXPECT_EQ(faults_of(scene(places("{position=[0,0,0]}"),
                            "[[wall]]\nname = \"far\"\nplane = { point = [0,0,-1e15], normal = "
                            "[0,0,1] }\n")),
            Texts{});
}

TEST_F(StartCheckTest, ALibraryWithNodesOfAnOlderVersionIsNamedOnce) {
  const std::string two_sets = scene(places("{position=[0,0,0]}")) +
                               "[[grains]]\nlibrary = \"grains.h5\"\n" +
                               places("{position=[0.01,0,0]}");
  EXPECT_EQ(warnings_of(two_sets), Texts{});
  write_seal(root_ / "grains.h5", "shape library", 3, root_ / "grains.h5");
  const Texts warnings = warnings_of(two_sets);
  ASSERT_EQ(warnings.size(), 1U);
  expect_parts(warnings[0], {"grains.h5 was written by an older version", "make it anew"});
}

TEST_F(StartCheckTest, WhatTheTimeStepDoesNotResolveIsSaid) {
  const auto wall = [&](const std::string& motion) {
    return scene(places("{position=[0,0,0.002], shape=\"sphere\"}"),
                 "step = 1e-5\n[[wall]]\nname = \"floor\"\nplane = { point = [0,0,0], normal = "
                 "[0,0,1] }\nmotion = { " +
                     motion + " }\n");
  };
  EXPECT_EQ(warnings_of(wall("amplitude = [0,0,1e-6], frequency = 1000")), Texts{});
  const Texts coarse = warnings_of(wall("amplitude = [0,0,1e-6], frequency = 1e4"));
  ASSERT_EQ(coarse.size(), 1U);
  expect_parts(coarse[0], {"wall \"floor\" oscillates at 1e+04 Hz", "10 time steps of 1e-05 s"});
  const auto faults = faults_of(wall("amplitude = [0,0,1e-6], frequency = 9e4"));
  ASSERT_EQ(faults.size(), 1U);
  expect_parts(faults[0], {"wall[0].motion: wall \"floor\" oscillates", "fewer than two"});
  const Texts fast = warnings_of(wall("velocity = [0,0,50]"));
  ASSERT_EQ(fast.size(), 1U);
  expect_parts(fast[0],
               {"wall \"floor\" moves 0.5 of the smallest grain's radius in one time step"});

  const Texts grains =
      warnings_of(scene(places("{position=[0,0,0], velocity=[0,0,100], shape=\"sphere\"}, "
                               "{position=[1,0,0], angular_velocity=[0,0,5e4]}"),
                        "step = 1e-5\n"));
  ASSERT_EQ(grains.size(), 2U);
  expect_parts(grains[0], {"grain 0 moves 1 of"});
  expect_parts(grains[1], {"grain 1 turns by 0.5 rad"});
}

/// A membrane whose mesh is as wide as grains: said before, and the run ends with the first grain
/// that is outside, after it has written what there is.
TEST_F(StartCheckTest, AGrainThatLeavesThroughTheMembraneEndsTheRun) {
  const std::string text = R"(
[contact]
normal_stiffness = "2e9 N/m^3"
[[grains]]
library = "grains.h5"
place = [{ position = ["1 mm", 0, "5 mm"], shape = "sphere", velocity = [2, 0, 0] }]
[[wall]]
name = "mould"
cylinder = { point = [0, 0, 0], axis = [0, 0, 1], radius = "4 mm" }
[[wall]]
name = "bottom"
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
[[wall]]
name = "top"
plane = { point = [0, 0, "10 mm"], normal = [0, 0, -1] }
[membrane]
mould = "mould"
spacing = "3.5 mm"
[[stage]]
name = "wrapped"
duration = "10 ms"
membrane = { pressure = "1 Pa" }
[output]
history_interval = 1000
)";
  const Texts warnings = warnings_of(text);
  ASSERT_EQ(warnings.size(), 1U);
  expect_parts(warnings[0], {"mesh may let grains through", "0.0035 m apart", "0.002 m wide",
                             "spacing of 0.001 m or less"});
  EXPECT_EQ(warnings_of(with(text, "3.5 mm", "0.9 mm")), Texts{});
  try {
    (void)run(text, {.folder = root_ / "run"});
    FAIL() << "the run did not end";
  } catch (const RunFailure& error) {
    expect_parts(error.what(),
                 {"grain 0, step ", "stage \"wrapped\": is outside the membrane, at (0.0",
                  "The last checkpoint is"});
  }
  const RunFolder folder{root_ / "run"};
  EXPECT_FALSE(folder.checkpoint_steps().empty());
  expect_parts(read_file(folder.json()), {"\"status\": \"failed\"", "is outside the membrane"});
  EXPECT_GE(read_history(folder.history()).rows.size(), 2U);
  // In a mesh that holds it, the same grain stays inside.
  EXPECT_EQ(run(with(text, "3.5 mm", "0.5 mm"), {.folder = root_ / "fine"}).end, RunEnd::complete);
}

TEST_F(StartCheckTest, NumbersOfOtherUnitsAreSaid) {
  const std::string sound = scene(places("{position=[0,0,0]}"));
  EXPECT_EQ(warnings_of(sound), Texts{});
  const Texts light = warnings_of(sound + "[material]\ndensity = 2.65\n");
  ASSERT_EQ(light.size(), 1U);
  expect_parts(light[0], {"2.65 kg/m^3 is less than that of any solid", "write \"2.65 g/cm^3\""});
  const Texts rough = warnings_of(sound + "[material]\nfriction = 30\n");
  ASSERT_EQ(rough.size(), 1U);
  expect_parts(rough[0], {"friction of 30", "write its tangent"});
}

/// A spring across the contact swings like one along it, so the stiffest of all sets the time step.
TEST_F(StartCheckTest, TheTimeStepFollowsTheStiffestSpring) {
  const auto step_of = [&](const std::string& stiffness) {
    SceneReading reading = read(
        with(scene(places("{position=[0,0,0]}")), "restitution = 0.5",
             "restitution = 0.5\n" + stiffness) +
        "[[wall]]\nname = \"floor\"\nplane = {point = [0, 0, \"-1 cm\"], normal = [0, 0, 1]}\n");
    const LoadedScene loaded = load_scene(reading);
    return choose_time_step(loaded.config, loaded.grains, loaded.shapes).step;
  };
  const double usual_step = step_of("");
  EXPECT_EQ(step_of("shear_stiffness = \"1e9 N/m^3\""), usual_step);
  EXPECT_NEAR(step_of("shear_stiffness = \"8e9 N/m^3\""), 0.5 * usual_step, 1e-12 * usual_step);
}

/// A twentieth of a sphere's surface is that of a lens with R d = 0.1 R^2, so a = sqrt(0.1) R.
TEST_F(StartCheckTest, TheTimeStepOfHertzFollowsFromTheElasticConstants) {
  SceneReading reading =
      read(with(scene(places("{position=[0,0,0]}")), "normal_stiffness = \"2e9 N/m^3\"",
                "law = \"hertz\"\nyoung_modulus = \"70 GPa\"\npoisson_ratio = 0.25"));
  const LoadedScene loaded = load_scene(reading);
  for (const SceneFault& fault : reading.faults) ADD_FAILURE() << describe(fault, "scene");
  const TimeStepChoice choice = choose_time_step(loaded.config, loaded.grains, loaded.shapes);
  const double expected = 2 * 70e9 / (1 - 0.25 * 0.25) * std::sqrt(0.1) * 1e-3;
  EXPECT_NEAR(choice.stiffness, expected, 0.01 * expected);
  EXPECT_DOUBLE_EQ(choice.step,
                   loaded.config.time.step_fraction * std::sqrt(choice.mass / choice.stiffness));
}

TEST_F(StartCheckTest, ATextWithFaultsOfSyntaxIsNotFilled) {
  const auto faults = faults_of(
      scene("fill = { count = 20, box = {\nlow = [0, 0, 0],\nhigh = [6 mm, 6 mm, 6 mm] } }"));
  for (const std::string& fault : faults) {
    EXPECT_EQ(fault.find("do not fit"), std::string::npos) << fault;
  }
}

TEST_F(StartCheckTest, SizesThatNoMachineHasAreRefusedBeforeTheyAreMade) {
  const auto vast = faults_of(scene("voxel = \"1e308 m\"\nplace = [{ position = [0,0,0] }]"));
  ASSERT_EQ(vast.size(), 1U);
  expect_parts(vast[0], {"grains[0].voxel: "});
}

TEST_F(StartCheckTest, KeysOfThousandsOfPartsAreAFault) {
  std::string deep = "a";
  for (int n = 0; n < 40000; ++n) deep += ".a";
  for (const std::string& text :
       {deep + " = 1\n", "[" + deep + "]\n", "[[" + deep + "]]\n", "x = { " + deep + " = 1 }\n",
        "x = [ { " + deep + " = 1 } ]\n", "t = \"\"\"\n\"\"\"\n" + deep + " = 1\n"}) {
    const auto faults = faults_of(text);
    ASSERT_EQ(faults.size(), 1U) << text.substr(0, 20);
    EXPECT_EQ(faults[0], ": a key has more than 16 parts");
  }
  // Dots in strings, comments and numbers are not parts of keys.
  const std::string dots(100, '.');
  const std::string quoted = "title = \"\\\"" + dots + "\" # " + dots + "\n";
  const auto rest = scene(places("{position=[0.0,0.0,0.0]}"));
  EXPECT_EQ(faults_of(quoted + rest), Texts{});
  EXPECT_EQ(faults_of("title = '''\n" + dots + "''' # \"\n" + rest), Texts{});
}

}  // namespace
}  // namespace reckon
