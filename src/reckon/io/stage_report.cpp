// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/io/stage_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "reckon/analysis/shear_curve.hpp"
#include "reckon/core/error.hpp"

namespace reckon {
namespace {

/// Numbers of a history by column and row.
class Columns {
 public:
  explicit Columns(const HistoryTable& history) : history_{history} {}

  [[nodiscard]] bool has(std::string_view name) const { return place(name).has_value(); }
  [[nodiscard]] double at(std::size_t row, std::string_view name) const {
    const std::optional<std::size_t> column = place(name);
    if (!column) {
      throw Error{{.place = "history.csv",
                   .problem = fmt::format("has no column \"{}\"", name),
                   .reason = "it was changed, or written by another version of reckon",
                   .fix = "Put its header back: docs/reference/history.md lists the columns."}};
    }
    const std::string& cell = history_.rows[row][*column];
    double value = std::numeric_limits<double>::quiet_NaN();
    std::from_chars(cell.data(), cell.data() + cell.size(), value);
    return value;
  }

 private:
  [[nodiscard]] std::optional<std::size_t> place(std::string_view name) const {
    const auto found = std::find(history_.header.begin(), history_.header.end(), name);
    if (found == history_.header.end()) return std::nullopt;
    return static_cast<std::size_t>(found - history_.header.begin());
  }

  const HistoryTable& history_;
};

constexpr std::array axes{"x", "y", "z"};
constexpr std::array tensor{"xx", "yy", "zz", "xy", "yz", "zx"};

/// The strain along the axis that the sample has been compressed along most, or a cell's shear if
/// that is larger.
std::string axial(const Columns& columns, std::size_t last_row) {
  std::size_t most = 0;
  const auto strain = [&](std::size_t axis) {
    return columns.at(last_row, fmt::format("strain_{}", axes[axis]));
  };
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (strain(axis) > strain(most)) most = axis;
  }
  for (const char* shear : {"cell_shear_xy", "cell_shear_xz", "cell_shear_yz"}) {
    if (!columns.has(shear)) break;
    if (std::abs(columns.at(last_row, shear)) > strain(most)) return shear;
  }
  return fmt::format("strain_{}", axes[most]);
}

/// The largest difference of the two stresses' components, over the mean stress.
double disagreement(const Columns& columns, std::size_t row) {
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

std::optional<StageFinding> finding(const std::string& name, bool free_volume,
                                    const Columns& columns, const std::vector<std::size_t>& rows) {
  const std::string strain = axial(columns, rows.back());
  if (strain.starts_with("cell_shear"))
    free_volume = false;  // the angle is of triaxial compression
  std::vector<ShearPoint> curve;
  std::vector<double> inertial_numbers;
  std::vector<double> disagreements;
  for (const std::size_t row : rows) {
    curve.push_back({std::abs(columns.at(row, strain)), columns.at(row, "volumetric_strain"),
                     columns.at(row, "friction_angle_deg")});
    inertial_numbers.push_back(columns.at(row, "inertial_number"));
    disagreements.push_back(disagreement(columns, row));
  }
  const auto summary = summarize(curve);
  if (!summary) return std::nullopt;
  return StageFinding{
      .stage = name,
      .free_volume = free_volume,
      .has_walls = !columns.has("cell_edge_x_m"),
      .shear = *summary,
      .axial_strain = curve.back().axial_strain,
      .void_ratio = columns.at(rows.back(), "void_ratio"),
      .stress_disagreement = median(disagreements),
      .largest_disagreement = *std::max_element(disagreements.begin(), disagreements.end()),
      .inertial_number = median(inertial_numbers)};
}

std::string paragraph(const StageFinding& f) {
  const auto dilatancy = [&](const char* words, double angle) {
    return f.free_volume ? fmt::format("{}{:.1f} deg", words, angle) : std::string{};
  };
  std::string text = fmt::format("  {}: peak friction angle {:.1f} deg at {:.2f} % strain{}\n",
                                 f.stage, f.shear.peak_friction_angle, 100 * f.shear.strain_at_peak,
                                 dilatancy(", dilatancy angle there ", f.shear.dilatancy_angle));
  text += fmt::format("    at {:.1f} % strain: friction angle {:.1f} deg{}, void ratio {:.3f}\n",
                      100 * f.axial_strain, f.shear.final_friction_angle,
                      dilatancy(", dilatancy angle ", f.shear.final_dilatancy_angle), f.void_ratio);
  if (f.has_walls) {
    text += fmt::format(
        "    stress by contacts and by walls: {:.2g} % apart in the median row, {:.2g} % at most\n",
        100 * f.stress_disagreement, 100 * f.largest_disagreement);
  }
  text += fmt::format(
      "    inertial number {:.1g}{}\n", f.inertial_number,
      f.quasi_static()
          ? ": quasi-static"
          : fmt::format(": too fast to count as quasi-static (above {}); lower the rate",
                        quasi_static_inertial_number));
  return text;
}

}  // namespace

std::string stage_note(const std::string& name, std::uint64_t steps, bool in_time,
                       const Measurement& measurement, const SampleMeasurement& sample) {
  std::string text = fmt::format("stage {} ended after {} steps", name, steps);
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

std::vector<StageFinding> stage_findings(const SceneConfig& scene, const HistoryTable& history) {
  if (scene.stages.empty() || !scene.output.sample) return {};
  const Columns columns{history};
  std::vector<StageFinding> findings;
  for (std::size_t n = 0; n < scene.stages.size(); ++n) {
    const auto& controls = scene.stages[n].controls;
    const auto held = std::count_if(controls.begin(), controls.end(), [](const ControlConfig& c) {
      return c.target == WallTarget::stress;
    });
    if (static_cast<std::size_t>(held) == controls.size()) continue;
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < history.rows.size(); ++row) {
      const bool known = columns.at(row, "mean_stress_Pa") > 0;
      if (known && columns.at(row, "stage") == static_cast<double>(n + 1)) rows.push_back(row);
    }
    const bool bulges =
        std::any_of(scene.stages.begin(), scene.stages.begin() + static_cast<std::ptrdiff_t>(n) + 1,
                    [](const StageConfig& s) { return s.membrane.has_value(); });
    if (rows.empty()) continue;
    const auto found = finding(scene.stages[n].name, held > 0 || bulges, columns, rows);
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
