// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>

#include "reckon/output/history.hpp"
#include "reckon/results/saved_fields.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

constexpr const char* cylinder_of_grains = R"(
[material]
friction = 0.4
[contact]
normal_stiffness = "2e9 N/m^3"
restitution = 0.5
[[grains]]
library = "grains.h5"
[grains.fill]
count = 40
cylinder = { point = [0, 0, 0], axis = [0, 0, 1], radius = "4 mm", low = 0, high = "25 mm" }
[[wall]]
name = "mould"
cylinder = { point = [0, 0, 0], axis = [0, 0, 1], radius = "4 mm" }
[[wall]]
name = "bottom"
plane = { point = [0, 0, 0], normal = [0, 0, 1] }
[[wall]]
name = "top"
plane = { point = [0, 0, "25 mm"], normal = [0, 0, -1] }
)";
constexpr const char* membrane = R"(
[membrane]
mould = "mould"
spacing = "0.5 mm"
modulus = "20 MPa"
friction = 0.3
)";
constexpr const char* wrapping = R"(
[time]
step_fraction = 0.3
[body]
damping = 100
[output]
history_interval = 25
fields_interval = 200
checkpoint_interval = 300
sample = true
[[stage]]
name = "press"
steps = 1000
friction = 0.1
damping = 500
control = [{ wall = "top", strain_rate = 78 }]
[[stage]]
name = "wrapped"
steps = 300
membrane = { pressure = "20 kPa" }
control = [{ wall = "top", stress = "20 kPa" }]
[[stage]]
name = "shear"
steps = 400
membrane = { pressure = "40 kPa", ramp = "4 ms" }
control = [{ wall = "top", strain_rate = 10 }]
)";

class MembraneRunTest : public testing::RunSceneTest {
 protected:
  static std::string scene() { return std::string{cylinder_of_grains} + membrane + wrapping; }
};

TEST_F(MembraneRunTest, BreaksAnywhereLeaveTheSameFiles) {
  (void)run(scene(), {.folder = root_ / "whole"});
  EXPECT_TRUE(std::filesystem::exists(root_ / "whole/membrane.pvd"));
  for (const std::uint64_t step : {977U, 1000U, 1001U, 1150U, 1300U, 1391U}) {
    const auto folder = root_ / ("broken_at_" + std::to_string(step));
    EXPECT_EQ(run_until(step, scene(), {.folder = folder}).end, RunEnd::interrupted);
    EXPECT_EQ(run(scene(), {.folder = folder, .resume = true}).end, RunEnd::complete);
    expect_equal_folders(folder, root_ / "whole");
  }
}

/// Stress by contacts and by walls and membrane; energy; the ramp of the pressure.
TEST_F(MembraneRunTest, StressesAgreeAndEnergyBalances) {
  const RunReport report = run(scene(), {.folder = root_ / "whole"});
  const auto stress = column("stress_xx_Pa");
  const auto on_walls = column("wall_stress_xx_Pa");
  const auto pressure = column("membrane_pressure_Pa");
  const auto nodes = column("membrane_nodes");
  EXPECT_EQ(pressure.front(), 0);
  EXPECT_EQ(*std::max_element(pressure.begin(), pressure.end()), 4e4);
  const auto ramped = [](double p) { return p > 2.1e4 && p < 3.9e4; };
  EXPECT_GT(std::count_if(pressure.begin(), pressure.end(), ramped), 2);
  EXPECT_GT(nodes.back(), 50);
  EXPECT_NEAR(stress.back(), on_walls.back(), 0.05 * stress.back());
  EXPECT_GT(stress.back(), 3e4);
  EXPECT_LT(std::abs(report.energy_error), 0.03 * report.energy_turnover);
}

TEST_F(MembraneRunTest, SavedFieldsHaveItsTrianglesWhileItIsInPlace) {
  (void)run(scene(), {.folder = root_ / "whole"});
  const RunFolder folder{root_ / "whole"};
  EXPECT_TRUE(read_fields(folder, 800).membrane_places.empty());
  const SavedFields fields = read_fields(folder, 1400);
  const std::size_t nodes = fields.membrane_places.size();
  const std::size_t triangles = fields.membrane_corners.size() / 3;
  // Rings of nodes with two triangles for each node but those of the last ring.
  const std::size_t around = nodes - triangles / 2;
  EXPECT_EQ(2 * (nodes - around), triangles);
  EXPECT_NEAR(static_cast<double>(around), 2 * std::numbers::pi * 4 / 0.5, 2);
  const auto [low, high] =
      std::minmax_element(fields.membrane_places.begin(), fields.membrane_places.end(),
                          [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
  EXPECT_NEAR(low->z, 0, 1e-5);
  EXPECT_NEAR(high->z, 0.025 + fields.wall_displacement[2].z, 1e-5);
}

TEST_F(MembraneRunTest, FaultsAreFound) {
  using Faults = std::vector<std::string>;
  EXPECT_EQ(faults_of(with(scene(), membrane)),
            (Faults{"stage[1].membrane: gives a pressure for a membrane that the scene does not "
                    "have"}));
  EXPECT_EQ(faults_of(with(with(scene(), "membrane = { pressure = \"20 kPa\" }"),
                           "membrane = { pressure = \"40 kPa\", ramp = \"4 ms\" }")),
            (Faults{"membrane: never takes its place, since no stage gives it a pressure"}));
  EXPECT_EQ(faults_of(with(scene(), "mould = \"mould\"", "mould = \"top\"")),
            (Faults{"membrane.mould: no cylinder is named \"top\""}));
  EXPECT_EQ(faults_of(with(scene(), "spacing = \"0.5 mm\"", "spacing = \"0.5 m\"")),
            (Faults{"membrane.spacing: is larger than the radius of the mould"}));
  EXPECT_EQ(faults_of(with(scene(), "spacing = \"0.5 mm\"", "spacing = \"1 nm\"")),
            (Faults{"membrane.spacing: makes 7.26e+14 nodes, more than 4e+06"}));
  EXPECT_EQ(faults_of(with(scene(), "normal_stiffness = \"2e9 N/m^3\"",
                           "law = \"linear\"\nnormal_stiffness = \"2e3 N/m\"")),
            (Faults{"membrane: needs a `normal_stiffness`"}));
}

}  // namespace
}  // namespace reckon
