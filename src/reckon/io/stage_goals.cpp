// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/io/stage_goals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "reckon/math/portable.hpp"

namespace reckon {
namespace {

/// The first planes that are moved by strain rate or speed.
const WallControl* driven_planes(const StageSetup& stage) {
  for (const WallControl& control : stage.controls) {
    if (control.target != WallTarget::stress) return &control;
  }
  return nullptr;
}

/// The largest along driven planes, or of an axis if there are none.
double strain_since_start(const Simulation& simulation, const SampleMeasurement& sample) {
  const StageSetup& stage = *simulation.stage();
  if (driven_planes(stage) == nullptr) {
    const Vec3& strain = sample.strain;
    return std::max({std::abs(strain.x), std::abs(strain.y), std::abs(strain.z)});
  }
  const auto start = simulation.space_at_stage_start();
  const auto now = simulation.space();
  if (!start || !now) return 0;
  double largest = 0;
  for (const WallControl& control : stage.controls) {
    if (control.target == WallTarget::stress) continue;
    const double change = length_along(control, *start) / length_along(control, *now);
    largest = std::max(largest, std::abs(portable::log(change)));
  }
  return largest;
}

struct WallStresses {
  double largest_error{0};                                  // of the servos, relative
  double driven{std::numeric_limits<double>::quiet_NaN()};  // on the first driven planes [Pa]
};

WallStresses wall_stresses(const Simulation& simulation) {
  WallStresses result;
  const auto space = simulation.space();
  const std::vector<WallReaction> reactions = simulation.wall_reactions();
  if (!space) return {std::numeric_limits<double>::infinity(), result.driven};
  for (const WallControl& control : simulation.stage()->controls) {
    const double stress = stress_on(control, reactions, *space);
    if (control.target == WallTarget::stress) {
      const double lacking = std::abs(stress - control.value);
      result.largest_error =
          std::max(result.largest_error, control.value > 0 ? lacking / control.value : lacking);
    } else if (&control == driven_planes(*simulation.stage())) {
      result.driven = stress;
    }
  }
  return result;
}

}  // namespace

bool reached(const StageGoal& goal, const Simulation& simulation, const Measurement& measurement,
             const SampleMeasurement& sample) {
  const WallStresses stresses = wall_stresses(simulation);
  if (goal.unbalanced_ratio) {
    const bool touching = measurement.contacts + measurement.wall_contacts > 0;
    if (!touching || !(measurement.unbalanced_ratio < *goal.unbalanced_ratio)) return false;
  }
  if (goal.stress_error && !(stresses.largest_error <= *goal.stress_error)) return false;
  if (goal.strain && !(strain_since_start(simulation, sample) >= *goal.strain)) return false;
  if (goal.stress_above && !(stresses.driven > *goal.stress_above)) return false;
  if (goal.stress_below && !(stresses.driven < *goal.stress_below)) return false;
  if (goal.void_ratio && !(sample.enclosed && sample.void_ratio <= *goal.void_ratio)) return false;
  return true;
}

}  // namespace reckon
