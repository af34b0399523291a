// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reckon/analysis/sample.hpp"
#include "reckon/analysis/shear_curve.hpp"
#include "reckon/output/history.hpp"
#include "reckon/simulation/config.hpp"

namespace reckon {

/// How a stage ended, in one line. `in_time`: its goal was met, or it had none.
[[nodiscard]] std::string stage_note(const std::string& name, std::uint64_t steps, bool in_time,
                                     const Measurement& measurement,
                                     const SampleMeasurement& sample);

/// Above this a stage counts as too fast for a quasi-static test (da Cruz et al. 2005).
constexpr double quasi_static_inertial_number = 1e-3;

/// The results of a stage that drives walls by strain rate or speed.
struct StageFinding {
  std::string stage;
  bool free_volume{false};  ///< some walls give way, so that dilatancy means something
  bool has_walls{true};     ///< a periodic cell has none to compare stresses with
  ShearSummary shear;
  // Along the axis that the test drives (StageSetup::axis), compression positive.
  double axial_strain{0};          ///< at its end, since it began
  double total_axial_strain{0};    ///< at its end, since step 0
  double deviator_at_start{0};     ///< signed q [Pa]
  double deviator_at_end{0};       ///< likewise [Pa]
  double void_ratio{0};            ///< at its end
  double stress_disagreement{0};   ///< of contacts and walls, over the mean stress: median row
  double largest_disagreement{0};  ///< likewise: the worst row
  double inertial_number{0};       ///< median

  [[nodiscard]] bool quasi_static() const {
    return inertial_number <= quasi_static_inertial_number;
  }
};

/// Whether a stage moves something by strain rate or speed.
[[nodiscard]] bool is_driven(const StageConfig& stage);

/// Empty without such stages, and where the history has no columns of the sample.
[[nodiscard]] std::vector<StageFinding> stage_findings(const SceneConfig& scene,
                                                       const HistoryTable& history);

/// The findings, a paragraph each.
[[nodiscard]] std::string stage_report(const SceneConfig& scene, const HistoryTable& history);

}  // namespace reckon
