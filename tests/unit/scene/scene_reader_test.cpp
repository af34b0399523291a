// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/scene_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/scene/scene_schema.hpp"
#include "reckon/scene/scene_writer.hpp"
#include "unit/scene/scene_text_fixture.hpp"

namespace reckon {
namespace {

class SceneReaderTest : public testing::SceneTextTest {
 protected:
  [[nodiscard]] SceneReading read(const std::string& text) const {
    return read_scene_text(text, directory_);
  }
  /// Every fault as "line:column: key: problem", without the advice.
  [[nodiscard]] std::vector<std::string> faults(const std::string& text) const {
    std::vector<std::string> out;
    for (SceneFault fault : read(text).faults) {
      fault.fix.clear();
      out.push_back(describe(fault, "").substr(1));
    }
    return out;
  }
  /// The faults of lines put below a sound scene, whose own lines are not counted.
  [[nodiscard]] std::vector<std::string> faults_below(const std::string& lines) const {
    return faults(std::string{sound} + lines);
  }
};

using Faults = std::vector<std::string>;

TEST_F(SceneReaderTest, ReadsEveryKindOfValue) {
  const SceneReading reading = read(R"(
title = "Settling"
seed = 7
[material]
density = "2.65 g/cm^3"
friction = 0.5
[contact]
law = "linear"
normal_stiffness = "30 kN/m"
restitution = 0.6
node_cap = 16
master = "smaller"
[body]
gravity = [0, 0, "-9.81 m/s^2"]
damping = "1.5 1/s"
[[grains]]
library = "sand.h5"
fill = { count = 500, box = { low = [0, 0, 0], high = ["2 cm", "20 mm", 0.05] } }
[[grains]]
library = "sand.h5"
[[grains.place]]
shape = "ball"
position = [0, 0, 1]
rotation = { axis = [0, 0, 2], angle = "90 deg" }
fixed = true
[[wall]]
name = "box"
box = { low = [0, 0, 0], high = [0.02, 0.02, 0.1], open_top = true }
[[wall]]
name = "plate"
plane = { point = [0, 0, 0.1], normal = [0, 0, -1] }
friction = 0.8
motion = { velocity = [0, 0, "-1 mm/s"], start = "10 ms", stop = 2 }
[time]
duration = "0.5 s"
[output]
surfaces = true
)");
  for (const SceneFault& fault : reading.faults) ADD_FAILURE() << describe(fault, "scene.toml");
  const SceneConfig& scene = reading.config;
  EXPECT_EQ(scene.title, "Settling");
  EXPECT_EQ(scene.seed, 7U);
  EXPECT_EQ(scene.material.density, 2650.0);
  EXPECT_EQ(scene.contact.law, ContactLawKind::linear);
  EXPECT_EQ(scene.contact.normal_stiffness, 30000.0);
  EXPECT_EQ(scene.contact.shear_stiffness, 0.9 * 30000.0);
  EXPECT_EQ(scene.contact.node_cap, 16U);
  EXPECT_EQ(scene.contact.master, MasterRule::smaller);
  EXPECT_EQ(scene.body.gravity, (Vec3{0, 0, -9.81}));
  EXPECT_EQ(scene.body.damping, 1.5);
  ASSERT_EQ(scene.grains.size(), 2U);
  EXPECT_EQ(scene.grains[0].library, (directory_ / "sand.h5").string());
  const auto& fill = std::get<FillPlacement>(scene.grains[0].placement);
  EXPECT_EQ(fill.count, 500U);
  EXPECT_EQ(std::get<BoxConfig>(fill.region).high, (Vec3{0.02, 0.02, 0.05}));
  const auto& placed = std::get<std::vector<ExplicitGrain>>(scene.grains[1].placement);
  ASSERT_EQ(placed.size(), 1U);
  EXPECT_EQ(placed[0].shape, "ball");
  EXPECT_NEAR(placed[0].orientation[0], std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(placed[0].orientation[3], std::sqrt(0.5), 1e-15);
  EXPECT_TRUE(placed[0].fixed);
  ASSERT_EQ(scene.walls.size(), 2U);
  EXPECT_TRUE(std::get<BoxConfig>(scene.walls[0].geometry).open_top);
  EXPECT_EQ(scene.walls[0].friction, 0.5);
  EXPECT_EQ(scene.walls[1].friction, 0.8);
  EXPECT_EQ(scene.walls[1].normal_stiffness, 30000.0);
  ASSERT_TRUE(scene.walls[1].motion.has_value());
  EXPECT_EQ(scene.walls[1].motion->velocity.z, -0.001);
  EXPECT_EQ(scene.walls[1].motion->start, 0.01);
  EXPECT_EQ(scene.time.duration, 0.5);
  EXPECT_TRUE(scene.output.surfaces);
}

TEST_F(SceneReaderTest, AbsentKeysKeepTheDefaultsOfTheConfig) {
  const SceneReading reading = read(sound);
  ASSERT_TRUE(reading.faults.empty());
  SceneConfig expected;
  expected.contact.normal_stiffness = 1e9;
  expected.time.steps = 10;
  expected.grains.push_back({.library = (directory_ / "sand.h5").string(),
                             .placement = std::vector<ExplicitGrain>{ExplicitGrain{}}});
  EXPECT_EQ(write_scene(reading.config), write_scene(expected));
}

TEST_F(SceneReaderTest, ListsAllFaultsOfAnInputInOneGo) {
  EXPECT_EQ(faults("title = 3\n"
                   "sede = 1\n"
                   "[material]\n"
                   "density = -1\n"
                   "frction = 0.5\n"
                   "[contact]\n"
                   "law = \"aera\"\n"
                   "node_cap = 1.5\n"
                   "[[grains]]\n"
                   "library = \"dust.h5\"\n"
                   "fill.count = 0\n"
                   "fill.box = { low = [0, 0, 0], high = [1, 1] }\n"
                   "[[wall]]\n"
                   "name = \"a\"\n"
                   "plane = { point = [0, 0, 0], normal = [0, 0, 0] }\n"
                   "[[wall]]\n"
                   "name = \"a\"\n"
                   "[time]\n"
                   "steps = 5\n"
                   "duration = \"1 m\"\n"),
            (Faults{
                "1:9: title: expected a text, found a whole number",
                "2:1: sede: unknown key",
                "4:11: material.density: -1 is out of range, must be above 0",
                "5:1: material.frction: unknown key",
                "6:1: contact.normal_stiffness: is missing",
                "7:7: contact.law: \"aera\" is none of \"area\", \"linear\", \"hertz\"",
                "8:12: contact.node_cap: expected a whole number, found a number",
                "10:11: grains[0].library: there is no file \"" +
                    (directory_ / "dust.h5").string() + "\"",
                "11:14: grains[0].fill.count: 0 is out of range, must be at least 1 and at most "
                "100000000",
                "12:38: grains[0].fill.box.high: expected 3 numbers [x, y, z], found an array of 2",
                "15:30: wall[0].plane.normal: `normal` must not be the zero vector",
                "16:1: wall[1]: needs one of `plane`, `box`, `cylinder`, `ledge`",
                "17:1: wall[1].name: no two walls may have the same name",
                "20:1: time.duration: contradicts `steps` on line 19",
                "20:12: time.duration: \"1 m\" is in m, but a number [s] is needed",
            }));
}

TEST_F(SceneReaderTest, SuggestsTheNearestKeyOrItsTable) {
  const auto fix_of = [&](const std::string& lines) {
    const SceneReading reading = read(std::string{sound} + lines);
    return reading.faults.size() == 1 ? reading.faults[0].fix : "not one fault";
  };
  EXPECT_EQ(fix_of("[material]\ndensty = 1\n"), "Did you mean `density`?");
  EXPECT_EQ(fix_of("friction = 1\n"),
            "`friction` belongs in [material], [[wall]], [membrane] or [[stage]].");
  EXPECT_EQ(fix_of("[body]\nseed = 1\n"), "`seed` belongs at the top, before any table.");
  EXPECT_EQ(fix_of("[material]\ncolour = 1\n"), "Known here: density, density_scaling, friction.");
  EXPECT_EQ(
      fix_of("[[wall]]\nname='w'\nplan = {}\nplane = { point = [0,0,0], normal = [0,0,1] }\n"),
      "Did you mean `plane`?");
}

TEST_F(SceneReaderTest, RefusesWrongKinds) {
  EXPECT_EQ(faults_below("material = 3\n"),
            (Faults{"4:12: material: expected a table, found a whole number"}));
  EXPECT_EQ(faults_below("wall = { name = 'a' }\n"),
            (Faults{"4:8: wall: expected a list of tables, found a table"}));
  EXPECT_EQ(faults_below("[[material]]\n"),
            (Faults{"4:1: material: expected a table, found an array"}));
  EXPECT_EQ(faults_below("wall = [3]\n"),
            (Faults{"4:9: wall[0]: expected a table, found a whole number"}));
  EXPECT_EQ(faults_below("body.gravity = [0, true, '1 kg']\n"),
            (Faults{"4:20: body.gravity: expected a number [m/s^2], found true or false",
                    "4:26: body.gravity: \"1 kg\" is in kg, but a number [m/s^2] is needed"}));
  EXPECT_EQ(faults_below("material.friction = '30 deg'\n"),
            (Faults{"4:21: material.friction: \"30 deg\" is in rad, but a number is needed"}));
  EXPECT_EQ(faults_below("material.density = '2650'\n"),
            (Faults{"4:20: material.density: \"2650\" has no unit, but a number [kg/m^3] is "
                    "needed"}));
  EXPECT_EQ(faults_below("material.density = nan\n"),
            (Faults{"4:20: material.density: must be a finite number"}));
  EXPECT_EQ(faults_below("output.surfaces = 1\n"),
            (Faults{"4:19: output.surfaces: expected true or false, found a whole number"}));
  EXPECT_EQ(faults_below("seed = -1\n"),
            (Faults{"4:8: seed: -1 is out of range, must be at least 0"}));
  EXPECT_EQ(
      faults_below("output.fields_interval = 1979-05-27\n"),
      (Faults{"4:26: output.fields_interval: expected a whole number, found a date or time"}));
}

TEST_F(SceneReaderTest, RefusesContradictions) {
  EXPECT_EQ(
      faults_below("contact.node_cap = 16\n"),
      (Faults{"4:9: contact.node_cap: `node_cap` belongs to law `linear`; law `area` does not "
              "depend on the number of nodes"}));
  EXPECT_EQ(faults_below("body.random_interval = 16\n"),
            (Faults{"4:6: body.random_interval: `random_interval` needs a `random_acceleration` "
                    "above zero"}));
  EXPECT_EQ(faults_below("time.step = 1e-6\ntime.step_fraction = 0.1\n"),
            (Faults{"5:6: time.step_fraction: contradicts `step` on line 4"}));
  const std::string wall = "[[wall]]\nname = 'w'\n";
  EXPECT_EQ(faults_below(wall + "box = { high = [0, 1, 1], low = [0, 0, 0] }\n"),
            (Faults{"6:27: wall[0].box.low: `low` must be less than `high` in x, y and z"}));
  EXPECT_EQ(faults_below(wall + "cylinder = { point = [0, 0, 0], axis = [0, 0, 0], radius = 0 }\n"),
            (Faults{"6:33: wall[0].cylinder.axis: `axis` must not be the zero vector",
                    "6:60: wall[0].cylinder.radius: 0 is out of range, must be above 0"}));
  EXPECT_EQ(
      faults_below("[[wall]]\nname = 'a.b'\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\n"
                   "motion = { amplitude = [1, 0, 0], start = 2, stop = 1 }\n"),
      (Faults{"5:1: wall[0].name: `name` must be letters, digits, `_` and `-` only",
              "7:12: wall[0].motion.amplitude: `amplitude` and `frequency` go together: both "
              "above zero or neither",
              "7:46: wall[0].motion.stop: `start` must come before `stop`"}));
}

TEST_F(SceneReaderTest, HertzTakesElasticConstantsInsteadOfStiffness) {
  const std::string rest =
      "[[grains]]\nlibrary = 'sand.h5'\nfill = { count = 5, box = { low = [0, 0, 0], high = [1, 1, "
      "1] "
      "} }\n[[wall]]\nname = 'floor'\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\n"
      "[time]\nsteps = 3\n";
  const SceneReading reading = read_scene_text(
      "[contact]\nlaw = 'hertz'\nyoung_modulus = '70 GPa'\npoisson_ratio = 0.3\n" + rest,
      directory_);
  for (const SceneFault& fault : reading.faults) ADD_FAILURE() << describe(fault, "scene.toml");
  EXPECT_EQ(reading.config.contact.young_modulus, 70e9);
  const SceneReading again = read_scene_text(write_scene(reading.config), "/");
  for (const SceneFault& fault : again.faults) ADD_FAILURE() << describe(fault, "scene.toml");
  EXPECT_EQ(again.config.contact.poisson_ratio, 0.3);

  const auto first_fault = [&](const std::string& contact) {
    return read_scene_text("[contact]\n" + contact + rest, directory_).faults.at(0).problem;
  };
  EXPECT_EQ(first_fault("law = 'hertz'\n"), "is missing");
  EXPECT_EQ(first_fault("law = 'hertz'\nyoung_modulus = 1e9\nnormal_stiffness = 1e9\n"),
            "law `hertz` takes no stiffness but `young_modulus` and `poisson_ratio`");
  EXPECT_EQ(first_fault("normal_stiffness = 1e9\npoisson_ratio = 0.1\n"),
            "`young_modulus` and `poisson_ratio` belong to law `hertz`");
}

TEST_F(SceneReaderTest, MissingTablesAreNamedByTheirRequiredKeys) {
  EXPECT_EQ(faults(""),
            (Faults{"1:1: contact.normal_stiffness: is missing", "1:1: grains: is missing",
                    "1:1: time: needs one of `duration`, `steps`"}));
}

TEST_F(SceneReaderTest, FaultsOfSyntaxDoNotHideTheOthers) {
  const Faults found = faults_below(
      "[material]\nfriction 0.5\ndensity = 'heavy'\n[body]\n"
      "damping = = 2\n");
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].substr(0, 4), "5:10") << found[0];
  EXPECT_EQ(found[1].substr(0, 4), "6:11") << found[1];
  EXPECT_EQ(found[2].substr(0, 4), "8:11") << found[2];
}

TEST_F(SceneReaderTest, ABrokenHeaderDoesNotMakeItsKeysUnknown) {
  const Faults found = faults_below("[material\nfriction = 0.5\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].substr(0, 2), "4:") << found[0];
}

TEST_F(SceneReaderTest, WrittenScenesReadBackAsTheSame) {
  const SceneReading first = read(R"(
title = "a \"quoted\" \\ title\twith\u0007bell"
material.friction = 0.1
contact.normal_stiffness = 1e9
time.duration = 0.1
[[grains]]
library = "sand.h5"
files = { positions = "sand.h5", rotations = "sand.h5" }
[[grains]]
library = "sand.h5"
[grains.fill]
count = 3
cylinder = { point = [0, 0, 0], axis = [1, 2, 3], radius = 1, low = 0, high = 1 }
[[grains]]
library = "sand.h5"
[[grains.place]]
position = [0, 0, 0]
orientation = [0, 1, 0, 0]
[[grains.place]]
position = [0, 0, 2]
[[wall]]
name = "w"
box = { low = [0, 0, 0], high = [0.1, 0.2, 0.30000000000000004] }
motion = { velocity = [1e-300, 0, 0] }
)");
  for (const SceneFault& fault : first.faults) ADD_FAILURE() << describe(fault, "first");
  const SceneConfig& scene = first.config;
  const std::string text = write_scene(scene);
  const SceneReading again = read(text);
  for (const SceneFault& fault : again.faults) ADD_FAILURE() << describe(fault, "again");
  EXPECT_EQ(write_scene(again.config), text);
  EXPECT_EQ(again.config.title, scene.title);
  ASSERT_EQ(again.config.grains.size(), 3U);
  EXPECT_EQ(std::get<std::vector<ExplicitGrain>>(again.config.grains[2].placement).size(), 2U);
  EXPECT_EQ(std::get<BoxConfig>(again.config.walls[0].geometry).high.z, 0.30000000000000004);
}

TEST_F(SceneReaderTest, AMissingSceneIsAnError) {
  EXPECT_THROW((void)read_scene_file(directory_ / "none.toml"), Error);
  EXPECT_THROW((void)read_scene_file(directory_), Error);
}

TEST(SceneSchema, TellsWhichTablesCannotBeLeftOut) {
  for (const SchemaRow& row : scene_schema().rows) {
    if (!row.table.empty() || row.type != "table") continue;
    const bool needed = row.name == "contact" || row.name == "time";
    // These mean something by not being there.
    const bool absent = row.name == "membrane" || row.name == "cell" || row.name == "bond";
    EXPECT_EQ(row.standard, needed ? "required" : absent ? "none" : "all defaults") << row.name;
  }
}

TEST(SceneSchema, EveryNumberHasAUnitAndEveryKeyAMeaningAndADefault) {
  for (const SchemaRow& row : scene_schema().rows) {
    const std::string name = row.table + "." + row.name;
    EXPECT_FALSE(row.meaning.empty()) << name;
    EXPECT_FALSE(row.standard.empty()) << name;
    if (row.type == "number" || row.type == "3 numbers" || row.type == "4 numbers" ||
        row.type == "whole number") {
      EXPECT_FALSE(row.unit.empty()) << name;
    }
  }
}

TEST(SceneSchema, ThePrintedReferenceIsTheCommittedPage) {
  std::ifstream page{RECKON_SOURCE_DIR "/docs/reference/scene.md"};
  ASSERT_TRUE(page) << "docs/reference/scene.md is missing";
  const std::string committed{std::istreambuf_iterator<char>{page}, {}};
  EXPECT_EQ(committed, scene_reference_markdown())
      << "run: reckon reference scene > docs/reference/scene.md";
}

}  // namespace
}  // namespace reckon
