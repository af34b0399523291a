// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "reckon/core/vtk_reader.hpp"
#include "reckon/output/checkpoint.hpp"
#include "reckon/output/history.hpp"
#include "reckon/results/run_analysis.hpp"
#include "reckon/results/run_surfaces.hpp"
#include "reckon/results/saved_fields.hpp"
#include "unit/run/run_scene_fixture.hpp"

namespace reckon {
namespace {

constexpr const char* cell_of_grains = R"(
[material]
friction = 0.4
[contact]
normal_stiffness = "2e9 N/m^3"
restitution = 0.5
[[grains]]
library = "grains.h5"
[grains.fill]
count = 48
velocity = [0.3, 0.2, -0.1]
box = { low = [0, 0, 0], high = ["10 mm", "10 mm", "10 mm"] }
[cell]
low = [0, 0, 0]
high = ["10 mm", "10 mm", "10 mm"]
[time]
step_fraction = 0.3
[output]
history_interval = 25
fields_interval = 200
checkpoint_interval = 300
sample = true
)";
constexpr const char* pressing = R"(
[[stage]]
name = "press"
steps = 1300
friction = 0.1
damping = 500
control = [{ wall = "cell", stress = "20 kPa", rate_limit = 200 }]
)";
constexpr const char* shearing = R"(
[[stage]]
name = "shear"
steps = 700
until = { strain = 0.2 }
control = [{ wall = "cell.y", stress = "20 kPa" }, { wall = "cell.xy", strain_rate = 20 }]
)";

class CellRunTest : public testing::RunSceneTest {
 protected:
  static std::string scene() { return std::string{cell_of_grains} + pressing + shearing; }
};

TEST_F(CellRunTest, BreaksAnywhereLeaveTheSameFiles) {
  (void)run(scene(), {.folder = root_ / "whole"});
  for (const std::uint64_t step : {777U, 1300U, 1301U, 1555U}) {
    const auto folder = root_ / ("broken_at_" + std::to_string(step));
    EXPECT_EQ(run_until(step, scene(), {.folder = folder}).end, RunEnd::interrupted);
    EXPECT_EQ(run(scene(), {.folder = folder, .resume = true}).end, RunEnd::complete);
    expect_equal_folders(folder, root_ / "whole");
  }
}

TEST_F(CellRunTest, TellsOfStressStrainAndWork) {
  const RunReport report = run(scene(), {.folder = root_ / "whole"});
  EXPECT_LT(std::abs(report.energy_error), 0.02 * report.energy_turnover);
  EXPECT_NE(report.stages.find("shear: peak friction angle"), std::string::npos) << report.stages;
  EXPECT_EQ(report.stages.find("by walls"), std::string::npos) << report.stages;
  const auto numbers = column("stage");
  const auto pressed =
      static_cast<std::size_t>(std::count(numbers.begin(), numbers.end(), 1.0)) - 1;
  const auto at = [&](const char* name, std::size_t row) { return column(name)[row]; };
  EXPECT_NEAR(at("stress_xx_Pa", pressed), 2e4, 2e3);
  EXPECT_NEAR(at("stress_zz_Pa", pressed), 2e4, 2e3);
  const double edge = at("cell_edge_x_m", pressed);
  EXPECT_LT(edge, 0.0085);
  EXPECT_NEAR(at("strain_x", pressed), std::log(0.01 / edge), 1e-9);
  EXPECT_NEAR(at("volume_m3", pressed),
              edge * at("cell_edge_y_m", pressed) * at("cell_edge_z_m", pressed), 1e-15);
  const std::size_t last = numbers.size() - 1;
  EXPECT_NEAR(at("cell_shear_xy", last), 0.2, 0.015);  // ended by its goal
  EXPECT_EQ(at("cell_edge_x_m", last), edge);
  EXPECT_LT(at("stress_xy_Pa", last), -2e3);
  EXPECT_GT(at("wall_work_J", last), at("wall_work_J", pressed));
}

/// ParaView files hold every grain inside the cell, and no contact longer than the reach of grains.
TEST_F(CellRunTest, FieldsShowGrainsInTheCell) {
  (void)run(scene(), {.folder = root_ / "whole"});
  const double edge = column("cell_edge_z_m").back();
  const RunFolder folder{root_ / "whole"};
  const auto last = [&](const char* kind) {
    return VtkReader{root_ / "whole" /
                     RunFolder::field_name(kind, folder.field_steps(kind).back())};
  };
  const auto points = last("grains").numbers(VtkSection::points, "Points", 3, 48);
  for (std::size_t n = 0; n < points.size(); n += 3) {
    EXPECT_LE(std::abs(points[n + 2] - 0.005), 0.5 * edge * (1 + 1e-12));
  }
  const VtkReader contacts = last("contacts");
  const auto ends = contacts.numbers(VtkSection::points, "Points", 3,
                                     contacts.tuples(VtkSection::points, "Points"));
  EXPECT_GT(ends.size(), 6U * 40);
  for (std::size_t n = 0; n + 5 < ends.size(); n += 6) {
    const Vec3 line{ends[n] - ends[n + 3], ends[n + 1] - ends[n + 4], ends[n + 2] - ends[n + 5]};
    EXPECT_LT(norm(line), 0.0022);
  }
}

/// The box that is drawn is that of the history, and cell_shift leads to unwrapped positions.
TEST_F(CellRunTest, FieldsHaveTheCellAndTheGrainsOwnWays) {
  (void)run(scene(), {.folder = root_ / "whole"});
  const RunFolder folder{root_ / "whole"};
  const std::uint64_t end = folder.field_steps("cell").back();
  const SavedFields fields = read_fields(folder, end);
  ASSERT_EQ(fields.cell_corners.size(), 8U);
  const auto& corner = fields.cell_corners;
  EXPECT_DOUBLE_EQ((corner[1] - corner[0]).x, column("cell_edge_x_m").back());
  EXPECT_DOUBLE_EQ((corner[2] - corner[0]).x, column("cell_lean_xy_m").back());
  EXPECT_DOUBLE_EQ((corner[4] - corner[0]).z, column("cell_edge_z_m").back());
  EXPECT_LT(norm(0.5 * (corner[0] + corner[7]) - Vec3{0.005, 0.005, 0.005}), 1e-15);
  const Checkpoint checkpoint =
      read_checkpoint(folder.checkpoint(folder.checkpoint_steps().back()));
  ASSERT_EQ(checkpoint.state.step, end);
  std::size_t elsewhere = 0;
  for (std::size_t n = 0; n < fields.grains.size(); ++n) {
    const SavedGrain& grain = fields.grains[n];
    if (grain.cell_shift != Vec3{}) ++elsewhere;
    EXPECT_LT(norm(grain.position + grain.cell_shift - checkpoint.state.grains[n].position), 1e-15);
  }
  EXPECT_GT(elsewhere, 0U);
}

/// Simple shear by 0.2 is the strain of nearly every grain, those that cross the border included.
TEST_F(CellRunTest, LocalStrainsDoNotJumpAtTheBorder) {
  (void)run(scene(), {.folder = root_ / "whole"});
  const double shear = column("cell_shear_xy").back() / std::sqrt(3.0);
  const RunAnalysis found = analyse_run(RunFolder{root_ / "whole"}, {});
  EXPECT_EQ(found.from, 1300U);
  EXPECT_GT(found.strains.back().shear, 0.7 * shear);
  EXPECT_LT(found.strains.back().largest, 2.5 * shear);
}

/// Surfaces made later from a checkpoint are those of the run itself, also beyond a border.
TEST_F(CellRunTest, SurfacesStandInTheCell) {
  (void)run(scene(), {.folder = root_ / "whole", .steps = 1300});
  const RunFolder folder{root_ / "whole"};
  (void)write_run_surfaces(folder, 1300);
  const auto points = [&](const char* kind) {
    const VtkReader file{folder.root() / RunFolder::field_name(kind, 1300)};
    return file.numbers(VtkSection::points, "Points", 3, file.tuples(VtkSection::points, "Points"));
  };
  const double reach = 0.5 * column("cell_edge_x_m").back() + 0.0013;
  const auto places = points("surfaces");
  EXPECT_GT(places.size(), 48U * 100);
  const auto [low, high] = std::minmax_element(places.begin(), places.end());
  EXPECT_GT(*low, 0.005 - reach);
  EXPECT_LT(*high, 0.005 + reach);
}

TEST_F(CellRunTest, FaultsAreFound) {
  using Faults = std::vector<std::string>;
  EXPECT_EQ(faults_of(scene()), Faults{});
  EXPECT_EQ(faults_of(with(scene(), "high = [\"10 mm\", \"10 mm\", \"10 mm\"]\n[time]",
                           "high = [\"10 mm\", \"4 mm\", \"10 mm\"]\n[time]")),
            (Faults{"cell: is 0.004 m wide along y, but must be 0.0052 m at least",
                    "grains[0].fill: reaches beyond the periodic cell along y"}));
  EXPECT_EQ(faults_of(scene() + "[body]\ngravity = [0, 0, -9.81]\n"),
            (Faults{"body.gravity: lets all grains fall for ever in a cell that is periodic along "
                    "all axes"}));
  EXPECT_EQ(faults_of(scene() + "[parallel]\ndecomposition = \"bins\"\n"),
            (Faults{"parallel.decomposition: `bins` knows no periodic cell"}));
  EXPECT_EQ(faults_of(scene() + "[[wall]]\nname = \"floor\"\nplane = { point = [0, 0, 0], normal = "
                                "[0, 0, 1] }\n"),
            (Faults{"wall: wall floor stands across z, along which the cell is periodic"}));
  const std::string open = with(scene(), "[cell]\n", "[cell]\nperiodic = \"xz\"\n");
  const std::string open_along_y = "the cell is not periodic along y";
  const std::string no_stress = "a stress needs a cell that is periodic along all axes";
  EXPECT_EQ(
      faults_of(open),
      (Faults{"stage[0].control[0].wall: " + open_along_y, "stage[0].control[0]: " + no_stress,
              "stage[1].control[0].wall: " + open_along_y, "stage[1].control[0]: " + no_stress,
              "stage[1].control[1].wall: " + open_along_y,
              "stage[1].until: needs walls that close off a space, which these do not"}));
  EXPECT_EQ(faults_of(with(scene(), "\"cell.xy\", strain_rate = 20", "\"cell.xy\", speed = 20")),
            (Faults{"stage[1].control[1]: shear takes a `strain_rate` only"}));
  EXPECT_EQ(
      faults_of(with(scene(), "\"cell.xy\", strain_rate = 20", "\"cell\", stress = 20")),
      (Faults{"stage[1].control[1].wall: another control of this stage moves this part of the "
              "cell already"}));
  EXPECT_EQ(
      faults_of(with(scene(), "\"cell.xy\", strain_rate = 20", "\"cell.x\", speed = 20")),
      (Faults{"stage[1].control[1]: a cell takes a `stress` or a `strain_rate`, no `speed`"}));
  EXPECT_EQ(faults_of(with(scene(), "\"cell.xy\"", "\"cell.yx\"")),
            (Faults{"stage[1].control[1].wall: no plane or pair of planes is named \"cell.yx\""}));
}

}  // namespace
}  // namespace reckon
