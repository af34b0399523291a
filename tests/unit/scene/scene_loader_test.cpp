// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/scene_loader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

class SceneLoaderTest : public testing::RunSceneTest {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream{root_ / name} << text;
  }
  [[nodiscard]] std::vector<std::string> faults(const std::string& lines) const {
    SceneReading reading = read_scene_text(head_ + lines, root_);
    (void)load_scene(reading);
    std::vector<std::string> out;
    for (const SceneFault& fault : reading.faults) out.push_back(describe(fault, "s"));
    return out;
  }
  [[nodiscard]] LoadedScene load(const std::string& lines) const {
    SceneReading reading = read(head_ + lines);
    LoadedScene scene = load_scene(reading);
    for (const SceneFault& fault : reading.faults) ADD_FAILURE() << describe(fault, "s");
    return scene;
  }
  const std::string head_ = "contact.normal_stiffness = 1e9\ntime.steps = 1\n";
};

TEST_F(SceneLoaderTest, PlacesGrainsByHand) {
  const LoadedScene scene = load(
      "[[grains]]\nlibrary = 'grains.h5'\n"
      "[[grains.place]]\nposition = [1, 2, 3]\norientation = [0, 0, 3, 0]\n"
      "angular_velocity = [0, 0, 5]\n"
      "[[grains.place]]\nposition = [0, 0, 0]\n"
      "[[grains.place]]\nshape = 'sphere'\nposition = [0, 0, 9]\nfixed = true\n"
      "[[grains]]\nlibrary = 'grains.h5'\n"
      "[[grains.place]]\nposition = [5, 0, 0]\n");
  ASSERT_EQ(scene.grains.size(), 4U);
  EXPECT_EQ(scene.shapes.size(), 4U);
  EXPECT_EQ(scene.grains[0].orientation, (Quaternion{0, 0, 1, 0}));
  EXPECT_EQ(scene.grains[0].angular_velocity_body, (Vec3{0, 0, -5}));  // half a turn about y
  EXPECT_EQ(scene.grains[0].shape, ShapeId{0});
  EXPECT_EQ(scene.grains[1].shape, ShapeId{1});
  EXPECT_EQ(scene.grains[2].shape, ShapeId{1});
  EXPECT_TRUE(scene.grains[2].prescribed);
  EXPECT_EQ(scene.grains[3].shape, ShapeId{2});
  EXPECT_EQ(scene.grains[3].id, GrainId{3});
}

TEST_F(SceneLoaderTest, ReadsLegacyPlaces) {
  write("p.dat", "1 2 3\n4 5 6\n7 8 9\n");
  write("r.dat", "0 0 0 1\n1 0 0 0\n0.5 -0.5 0.5 0.5\n");
  write("a.dat", "1 0 0\n0 1 0\n0 0 1\n");
  const LoadedScene scene = load(
      "body.acceleration_file = 'a.dat'\n"
      "[[grains]]\nlibrary = 'grains.h5'\nvoxel = '10 mm'\n"
      "files = { positions = 'p.dat', rotations = 'r.dat' }\n");
  ASSERT_EQ(scene.grains.size(), 3U);
  EXPECT_EQ(scene.grains[1].position, (Vec3{0.04, 0.05, 0.06}));
  EXPECT_EQ(scene.grains[0].orientation, (Quaternion{1, 0, 0, 0}));
  EXPECT_EQ(scene.grains[1].orientation, (Quaternion{0, 0, 1, 0}));
  EXPECT_EQ(scene.grains[2].orientation, (Quaternion{0.5, 0.5, 0.5, -0.5}));
  EXPECT_EQ(scene.grains[2].shape, ShapeId{0});
  ASSERT_EQ(scene.own_accelerations.size(), 3U);
  EXPECT_EQ(scene.own_accelerations[1], (Vec3{0, 1, 0}));
}

TEST_F(SceneLoaderTest, NamesWhatIsWrongInTheFilesWhereTheSceneNamesThem) {
  write("broken.h5", "not a library");
  write("p.dat", "1 2 3\n4 5\n");
  write("r.dat", "0 0 0 1\n");
  const std::vector<std::string> found = faults(
      "[[grains]]\nlibrary = 'broken.h5'\nplace = [{ position = [0, 0, 0] }]\n"
      "[[grains]]\nlibrary = 'grains.h5'\n"
      "place = [{ position = [0, 0, 0], shape = 'shpere' }]\n"
      "[[grains]]\nlibrary = 'grains.h5'\nfiles = { positions = 'p.dat', rotations = 'r.dat' }\n"
      "[[grains]]\nlibrary = 'grains.h5'\n"
      "fill = { count = 9, box = { low = [0, 0, 0], high = [0.005, 0.005, 0.003] } }\n");
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].find("s:4:11: grains[0].library: "), 0U) << found[0];
  EXPECT_EQ(found[1],
            "s:8:42: grains[1].place[0].shape: the library has no shape \"shpere\". Did you mean "
            "\"sphere\"?");
  EXPECT_EQ(found[2].find("s:11:23: grains[2].files.positions: "), 0U) << found[2];
  EXPECT_NE(found[2].find("p.dat:2: has 2 numbers (3 are needed)"), std::string::npos) << found[2];
  EXPECT_EQ(found[3].find("s:14:8: grains[3].fill: "), 0U) << found[3];
  EXPECT_NE(found[3].find("do not fit"), std::string::npos) << found[3];
}

TEST_F(SceneLoaderTest, AccelerationsMustMatchTheGrains) {
  write("a.dat", "1 0 0\n0 1 0\n");
  const std::vector<std::string> found = faults(
      "body.acceleration_file = 'a.dat'\n"
      "[[grains]]\nlibrary = 'grains.h5'\nplace = [{ position = [0, 0, 0] }]\n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].find("s:3:26: body.acceleration_file: has 2 lines, but there are 1 grains"),
            0U)
      << found[0];
}

TEST_F(SceneLoaderTest, ATimeStepMustComeOutOfTheScene) {
  const std::vector<std::string> fixed = faults(
      "[[grains]]\nlibrary = 'grains.h5'\nplace = [{ position = [0, 0, 0], fixed = true }]\n");
  ASSERT_EQ(fixed.size(), 1U);
  EXPECT_EQ(
      fixed[0],
      "s:2:14: time.steps: the rule for the time step gives inf. Where no grain moves freely, "
      "give time.step.");
  SceneReading reading = read_scene_text(
      "contact.normal_stiffness = 1e9\ntime = { duration = 1e9, step = 1e-12 }\n"
      "[[grains]]\nlibrary = 'grains.h5'\nplace = [{ position = [0, 0, 0] }]\n",
      root_);
  (void)load_scene(reading);
  ASSERT_EQ(reading.faults.size(), 1U);
  EXPECT_EQ(reading.faults[0].key, "time.duration");
}

}  // namespace
}  // namespace reckon
