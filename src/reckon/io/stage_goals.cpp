// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/io/stage_goals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace reckon {
namespace {

struct WallStresses {
  double largest_error{0};  // of the servos, relative
  double driven{std::numeric_limits<double>::quiet_NaN()};  // on the first driven planes [Pa]
};

WallStresses wall_stresses(const Simulation& simulation) {
  WallStresses result;
  const auto space =
      enclosure_of(simulation.setup().walls, simulation.wall_contacts().poses());
  const std::vector<WallReaction> reactions = simulation.wall_reactions();
  if (!space) return {std::numeric_limits<double>::infinity(), result.driven};
  for (const WallControl& control : simulation.stage()->controls) {
    const double stress = stress_on(control, reactions, *space);
    if (control.target == WallTarget::stress) {
      const double lacking = std::abs(stress - control.value);
      result.largest_error = std::max(
          result.largest_error, control.value > 0 ? lacking / control.value : lacking);
    } else if (std::isnan(result.driven)) {
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
  if (goal.strain) {
    const Vec3& strain = sample.strain;
    const double largest = std::max({std::abs(strain.x), std::abs(strain.y), std::abs(strain.z)});
    if (!(largest >= *goal.strain)) return false;
  }
  if (goal.stress_above && !(stresses.driven > *goal.stress_above)) return false;
  if (goal.stress_below && !(stresses.driven < *goal.stress_below)) return false;
  if (goal.void_ratio && !(sample.enclosed && sample.void_ratio <= *goal.void_ratio)) return false;
  return true;
}

}  // namespace reckon
