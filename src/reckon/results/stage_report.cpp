// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/results/stage_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "reckon/analysis/shear_curve.hpp"
#include "reckon/simulation/stage_setup.hpp"
#include "reckon/text/human.hpp"

namespace reckon {
namespace {

constexpr std::array tensor{"xx", "yy", "zz", "xy", "yz", "zx"};

/// The largest difference of the two stresses' components, over the mean stress.
double disagreement(const HistoryColumns& columns, std::size_t row) {
  double largest = 0;
  for (const char* component : tensor) {
    largest =
        std::max(largest, std::abs(columns.at(row, fmt::format("stress_{}_Pa", component)) -
                                   columns.at(row, fmt::format("wall_stress_{}_Pa", component))));
  }
  return largest / columns.at(row, "mean_stress_Pa");
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// `before`: the row at which the stage began.
std::optional<StageFinding> finding(const StageConfig& stage, bool free_volume,
                                    const HistoryColumns& columns, std::size_t before,
                                    const std::vector<std::size_t>& rows) {
  const auto parts = cell_axes_named(driven_control(stage)->wall);
  const bool is_sheared = !parts.empty() && is_shear(parts.front());
  const double start = columns.at(before, "axial_strain");
  std::vector<ShearPoint> curve;
  std::vector<double> inertial_numbers;
  std::vector<double> disagreements;
  for (const std::size_t row : rows) {
    curve.push_back({std::abs(columns.at(row, "axial_strain") - start),
                     columns.at(row, "volumetric_strain"), columns.at(row, "friction_angle_deg")});
    inertial_numbers.push_back(columns.at(row, "inertial_number"));
    disagreements.push_back(disagreement(columns, row));
  }
  const auto summary = summarize(curve);
  if (!summary) return std::nullopt;
  const std::size_t last = rows.back();
  const double strain = columns.at(last, "axial_strain") - start;
  return StageFinding{
      .stage = stage.name,
      // The angle of dilatancy is that of compression.
      .free_volume = free_volume && !is_sheared && strain > 0,
      .has_walls = !columns.has("cell_edge_x_m"),
      .shear = *summary,
      .axial_strain = strain,
      .total_axial_strain = columns.at(last, "axial_strain"),
      .deviator_at_start = columns.at(before, "axial_deviator_Pa"),
      .deviator_at_end = columns.at(last, "axial_deviator_Pa"),
      .void_ratio = columns.at(last, "void_ratio"),
      .stress_disagreement = median(disagreements),
      .largest_disagreement = *std::max_element(disagreements.begin(), disagreements.end()),
      .inertial_number = median(inertial_numbers)};
}

std::string paragraph(const StageFinding& f) {
  const auto dilatancy = [&](const char* words, double angle) {
    // Too few rows around the peak show no slope.
    const bool is_known = f.free_volume && !std::isnan(angle);
    return is_known ? fmt::format("{}{:.1f} deg", words, angle) : std::string{};
  };
  std::string text = fmt::format("  {}: peak friction angle {:.1f} deg at {:.2f} % strain{}{}\n",
                                 f.stage, f.shear.peak_friction_angle, 100 * f.shear.strain_at_peak,
                                 dilatancy(", dilatancy angle there ", f.shear.dilatancy_angle),
                                 f.shear.still_rising ? ", still rising at the end" : "");
  text += fmt::format("    at {:.1f} % strain: friction angle {:.1f} deg{}, void ratio {:.3f}\n",
                      100 * std::abs(f.axial_strain), f.shear.final_friction_angle,
                      dilatancy(", dilatancy angle ", f.shear.final_dilatancy_angle), f.void_ratio);
  text += fmt::format(
      "    along the driven axis, compression positive: q from {:.4g} to {:.4g} Pa, strain {:.3g} "
      "% in the stage, {:.3g} % since the start\n",
      f.deviator_at_start, f.deviator_at_end, 100 * f.axial_strain, 100 * f.total_axial_strain);
  if (f.has_walls) {
    text += fmt::format(
        "    stress by contacts and by walls: {:.2g} % apart in the median row, {:.2g} % at most\n",
        100 * f.stress_disagreement, 100 * f.largest_disagreement);
  }
  text += fmt::format(
      "    inertial number {}{}\n", human_beside(f.inertial_number, quasi_static_inertial_number),
      f.quasi_static()
          ? ": quasi-static"
          : fmt::format(": too fast to count as quasi-static (above {}); lower the rate",
                        quasi_static_inertial_number));
  return text;
}

}  // namespace

std::string stage_note(const std::string& name, std::uint64_t steps, bool in_time,
                       const Measurement& measurement, const SampleMeasurement& sample) {
  std::string text = fmt::format("stage {} ended after {}", name, counted(steps, "step"));
  if (!in_time) text += ", its time being over before its goal was reached";
  text += fmt::format(": unbalanced ratio {:.2g}", measurement.unbalanced_ratio);
  if (sample.enclosed) {
    text += fmt::format(", void ratio {:.3f}, mean stress {:.4g} Pa, coordination {:.2f}",
                        sample.void_ratio, sample.invariants.mean, sample.coordination);
    if (sample.void_ratio < 0) {
      text +=
          "; TOO LITTLE SPACE for the grains: they have gone through walls or the membrane, or "
          "deep into each other";
    }
  }
  return text;
}

bool is_driven(const StageConfig& stage) { return driven_control(stage) != nullptr; }

std::vector<StageFinding> stage_findings(const SceneConfig& scene, const HistoryTable& history) {
  if (scene.stages.empty() || !scene.output.sample) return {};
  const HistoryColumns columns{history};
  std::vector<StageFinding> findings;
  bool bulges = false;
  for (std::size_t n = 0; n < scene.stages.size(); ++n) {
    const StageConfig& stage = scene.stages[n];
    bulges = bulges || stage.membrane.has_value();
    if (!is_driven(stage)) continue;
    const bool gives_way =
        std::any_of(stage.controls.begin(), stage.controls.end(),
                    [](const ControlConfig& c) { return c.target == WallTarget::stress; });
    std::vector<std::size_t> rows;
    std::optional<std::size_t> before;  // the row at which the stage began
    for (std::size_t row = 0; row < history.rows.size(); ++row) {
      const double number = columns.at(row, "stage");
      if (number < static_cast<double>(n + 1) || !before) before = row;
      const bool known = columns.at(row, "mean_stress_Pa") > 0;
      if (known && number == static_cast<double>(n + 1)) rows.push_back(row);
    }
    if (rows.empty()) continue;
    const auto found = finding(stage, gives_way || bulges, columns, *before, rows);
    if (found) findings.push_back(*found);
  }
  return findings;
}

std::string stage_report(const SceneConfig& scene, const HistoryTable& history) {
  std::string text;
  for (const StageFinding& found : stage_findings(scene, history)) text += paragraph(found);
  return text;
}

}  // namespace reckon
