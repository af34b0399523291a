// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/run/stage_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reckon/results/stage_report.hpp"
#include "reckon/simulation/stage_setup.hpp"
#include "reckon/text/human.hpp"

namespace reckon {
namespace {

std::string in_words(const ControlConfig& control) {
  switch (control.target) {
    case WallTarget::stress:
      return fmt::format("{} held at {:.4g} Pa (at most {:.3g} 1/s)", control.wall, control.value,
                         control.rate_limit.value_or(0));
    case WallTarget::strain_rate:
      return fmt::format("{} at {:.4g} 1/s", control.wall, control.value);
    case WallTarget::speed:
      return fmt::format("{} at {:.4g} m/s", control.wall, control.value);
  }
  return {};
}

}  // namespace

std::vector<StagePlan> plan_stages(const LoadedScene& scene, double time_step) {
  std::vector<StagePlan> plans;
  const SceneConfig& config = scene.config;
  const double diameter = config.stages.empty() ? 0 : mean_diameter(scene.grains, scene.shapes);
  double held = 0;  // the last stress that is known [Pa]
  for (const StageConfig& stage : config.stages) {
    StagePlan plan{.name = stage.name,
                   .most_steps = most_steps(stage, time_step),
                   .has_goal = stage.until.has_value()};
    double rate = 0;
    double stress = 0;
    for (const ControlConfig& control : stage.controls) {
      plan.controls += (plan.controls.empty() ? "" : ", ") + in_words(control);
      if (control.target == WallTarget::stress) stress = std::max(stress, control.value);
      if (control.target == WallTarget::strain_rate) rate = std::max(rate, std::abs(control.value));
    }
    if (stage.membrane) {
      plan.controls += fmt::format("{}membrane at {:.4g} Pa", plan.controls.empty() ? "" : ", ",
                                   stage.membrane->pressure);
      stress = std::max(stress, stage.membrane->pressure);
    }
    if (stress > 0) held = stress;
    if (rate > 0 && held > 0) {
      const double density = config.material.inertial_density();
      plan.pace = {rate, held, rate / rate_at(1, held, diameter, density),
                   rate_at(quasi_static_inertial_number, held, diameter, density)};
    }
    plans.push_back(std::move(plan));
  }
  return plans;
}

std::vector<std::string> stage_lines(const StagePlan& plan, double time_step) {
  std::vector<std::string> lines{fmt::format(
      "{}: {}{} ({:.4g} s); {}", plan.name, plan.has_goal ? "at most " : "",
      counted(plan.most_steps, "step"), static_cast<double>(plan.most_steps) * time_step,
      plan.controls.empty() ? "walls stand" : plan.controls)};
  if (plan.pace) {
    const StagePlan::Pace& pace = *plan.pace;
    const bool slow = pace.inertial_number <= quasi_static_inertial_number;
    lines.push_back(fmt::format("inertial number {} at {:.4g} Pa: {}; {} makes {:.3g} 1/s",
                                human_beside(pace.inertial_number, quasi_static_inertial_number),
                                pace.stress,
                                slow ? "quasi-static" : "TOO FAST to count as quasi-static",
                                quasi_static_inertial_number, pace.advised_rate));
  }
  return lines;
}

}  // namespace reckon
