// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
// The paper authors' public code as an oracle: examples/legacy592/scene.toml on the legacy files,
// against the trajectories that the code computed.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "reckon/core/file.hpp"
#include "reckon/scene/scene_loader.hpp"
#include "reckon/simulation/setup.hpp"
#include "support/legacy_data.hpp"

namespace reckon {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t grain_count = 592;

/// Frames of 592 positions: before steps 0, 50, 100, 150 and 200.
std::vector<std::vector<Vec3>> reference(const fs::path& data, const std::string& name) {
  std::ifstream file{data / ("reference_positions_" + name + ".dat")};
  std::vector<std::vector<Vec3>> frames(5, std::vector<Vec3>(grain_count));
  for (auto& frame : frames) {
    for (Vec3& p : frame) file >> p.x >> p.y >> p.z;
  }
  EXPECT_TRUE(file.good() || file.eof());
  return frames;
}

class Legacy592 : public testing::LegacyDataTest {
 protected:
  /// Largest distance from the reference at each of its frames, with this friction.
  std::vector<double> distances(double friction, double wall_friction, const std::string& name) {
    for (const char* kind : {"positions", "rotations", "accelerations"}) {
      const std::string file = std::string{kind} + "_s592.dat";
      fs::copy_file(data_ / file, folder_ / file, fs::copy_options::overwrite_existing);
    }
    fs::copy_file(fs::path{RECKON_SOURCE_DIR} / "examples/legacy592/scene.toml",
                  folder_ / "scene.toml", fs::copy_options::overwrite_existing);
    SceneReading reading = read_scene_file(folder_ / "scene.toml");
    LoadedScene scene = load_scene(reading);
    EXPECT_TRUE(reading.faults.empty());
    scene.config.material.friction = friction;
    scene.config.walls[0].friction = wall_friction;
    PreparedScene prepared = prepare(scene);
    Simulation simulation{prepared.setup, prepared.initial};
    std::vector<double> largest;
    for (const auto& frame : reference(data_, name)) {
      const std::vector<GrainState> now = simulation.grain_states();
      double worst = 0;
      for (std::size_t g = 0; g < grain_count; ++g) {
        worst = std::max(worst, norm(now[g].position - frame[g]));
      }
      largest.push_back(worst);
      for (int step = 0; step < 50; ++step) simulation.step();
    }
    return largest;
  }
};

TEST_F(Legacy592, WithoutFrictionPathsAgreeToRounding) {
  const std::vector<double> found = distances(0, 0, "mu0");
  EXPECT_EQ(found[0], 0);
  for (const double distance : found) EXPECT_LT(distance, 1e-9);  // voxels, of a box of 200
}

TEST_F(Legacy592, WithFrictionPathsPartByTheReferencesShearFaults) {
  const std::vector<double> found = distances(0.65, 0.8, "mu065");
  EXPECT_EQ(found[0], 0);
  EXPECT_LT(found[1], 0.05);
  EXPECT_LT(found[4], 0.2);
}

/// Readers who put the reference's faults in must find the lines that the default engine runs.
TEST(Legacy592Page, NamesTheCodeOfTheDefaultEngine) {
  const std::string root = RECKON_SOURCE_DIR "/";
  const std::string page = read_file(root + "docs/verification/legacy592.md");
  const auto has = [&](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  };
  has(page, "`answer()` of `src/reckon/contact/law_lanes.cpp`");
  has(page, "`rotate_between(before.shear_force[n], normal, before.normal[n])`");
  has(read_file(root + "src/reckon/contact/law_lanes.cpp"),
      "rotate_between(before.shear_force[n], before.normal[n], normal)");
  has(page, "`TouchBatch::sum()` of `src/reckon/contact/touch_batch.hpp`");
  has(page, "`new_springs.push_back(gone)`");
  const std::string batch = read_file(root + "src/reckon/contact/touch_batch.hpp");
  has(batch, "let_go = [&](const NodeSpring& gone)");
  has(batch, "new_springs.push_back(");
  has(page, "`ChunkStep::sum()` of `src/reckon/contact/grain_contacts_near.cpp`");
  has(page, "`after.set(lane, before.get(lane, 0, false))` instead of `after.set(lane, {})`");
  has(read_file(root + "src/reckon/contact/grain_contacts_near.cpp"), "after.set(lane, {});");
  has(page, "`remove_leaving()` of `src/reckon/contact/pair_lanes.cpp`");
  has(read_file(root + "src/reckon/contact/pair_lanes.cpp"), "remove_leaving(LaneChunk& chunk)");
}

}  // namespace
}  // namespace reckon
