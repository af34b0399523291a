// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/stage_goals.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "reckon/math/portable.hpp"
#include "reckon/simulation/stage_setup.hpp"

namespace reckon {
namespace {

/// The planes, and the parts of the cell, whose strain and stress a goal means.
struct Watched {
  std::vector<WallControl> planes;
  std::vector<CellControl> parts;
};

/// The planes of the goal, or otherwise those that the stage moves by strain rate or speed.
Watched watched_by(const StageGoal& goal, const Simulation& simulation) {
  Watched watched;
  const StageSetup& stage = *simulation.stage();
  if (goal.wall.empty()) {
    const auto is_driven = [](const auto& control) { return control.target != WallTarget::stress; };
    std::ranges::copy_if(stage.controls, std::back_inserter(watched.planes), is_driven);
    std::ranges::copy_if(stage.cell_controls, std::back_inserter(watched.parts), is_driven);
    return watched;
  }
  if (simulation.cell() != nullptr) {
    for (const CellAxis axis : cell_axes_named(goal.wall)) {
      watched.parts.push_back({.name = goal.wall, .axis = axis, .target = WallTarget::strain_rate});
    }
  }
  for (auto& planes : planes_named(simulation.setup().walls, goal.wall)) {
    watched.planes.push_back(
        {.name = goal.wall, .walls = std::move(planes), .target = WallTarget::strain_rate});
  }
  return watched;
}

double strain_of(const CellControl& control, const CellState& state,
                 const SampleMeasurement& sample) {
  if (!is_shear(control.axis)) return sample.strain[static_cast<int>(control.axis)];
  const Vec3 shear = state.shear - state.shear_at_stage_start;
  return shear[static_cast<int>(control.axis) - static_cast<int>(CellAxis::xy)];
}

/// The largest of the watched values, or of an axis if there are none.
double strain_since_start(const Watched& watched, const Simulation& simulation,
                          const SampleMeasurement& sample) {
  if (watched.parts.empty() && watched.planes.empty()) {
    const Vec3& strain = sample.strain;
    return std::max({std::abs(strain.x), std::abs(strain.y), std::abs(strain.z)});
  }
  double largest = 0;
  for (const CellControl& part : watched.parts) {
    largest = std::max(largest, std::abs(strain_of(part, simulation.cell_state(), sample)));
  }
  const auto start = simulation.space_at_stage_start();
  const auto now = simulation.space();
  if (!start || !now) return largest;
  for (const WallControl& planes : watched.planes) {
    const double change = length_along(planes, *start) / length_along(planes, *now);
    largest = std::max(largest, std::abs(portable::log(change)));
  }
  return largest;
}

struct Stresses {
  double largest_error{0};      // of the servos, relative
  std::vector<double> watched;  // [Pa]
};

Stresses stresses_now(const Watched& watched, const Simulation& simulation) {
  Stresses result;
  const auto compare = [&result](double stress, double target) {
    const double lacking = std::abs(stress - target);
    result.largest_error = std::max(result.largest_error, target > 0 ? lacking / target : lacking);
  };
  const StageSetup& stage = *simulation.stage();
  if (simulation.cell() != nullptr && !(stage.cell_controls.empty() && watched.parts.empty())) {
    const CellReaction reaction = simulation.cell_reaction();
    for (const CellControl& control : stage.cell_controls) {
      if (control.target != WallTarget::stress) continue;
      compare(stress_of(control.axis, reaction, *simulation.cell()), control.value);
    }
    for (const CellControl& part : watched.parts) {
      const double stress = stress_of(part.axis, reaction, *simulation.cell());
      // Grains resist shear against its direction.
      result.watched.push_back(is_shear(part.axis) && part.value >= 0 ? -stress : stress);
    }
  }
  if (stage.controls.empty() && watched.planes.empty()) return result;
  const auto space = simulation.space();
  const std::vector<WallReaction> reactions = simulation.wall_reactions();
  if (!space) {
    result.largest_error = std::numeric_limits<double>::infinity();
    return result;
  }
  for (const WallControl& control : stage.controls) {
    if (control.target != WallTarget::stress) continue;
    compare(stress_on(control, reactions, *space), control.value);
  }
  for (const WallControl& planes : watched.planes) {
    result.watched.push_back(stress_on(planes, reactions, *space));
  }
  return result;
}

/// Whether there are stresses that are watched and all of them are so.
template <class Condition>
bool all_stresses(const Stresses& stresses, Condition&& condition) {
  return !stresses.watched.empty() && std::ranges::all_of(stresses.watched, condition);
}

}  // namespace

bool HeldCondition::look(std::uint64_t step, bool holds, std::uint64_t span) {
  if (!holds) {
    since_.reset();
  } else if (!since_) {
    since_ = step;
  }
  return since_ && step - *since_ >= span;
}

double periods_of(const StageGoal& goal) {
  if (goal.unbalanced_ratio || goal.stress_error || goal.overlap) return rest_periods;
  return goal.stress_above || goal.stress_below ? passing_periods : 0;
}

GoalState look_at(const StageGoal& goal, const Simulation& simulation,
                  const Measurement& measurement, const SampleMeasurement& sample) {
  const Watched watched = watched_by(goal, simulation);
  const Stresses stresses = stresses_now(watched, simulation);
  const auto holds = [&] {
    if (goal.unbalanced_ratio && !is_at_rest(measurement, *goal.unbalanced_ratio)) return false;
    if (goal.stress_error && !(stresses.largest_error <= *goal.stress_error)) return false;
    const auto above = [&](double stress) { return stress > *goal.stress_above; };
    const auto below = [&](double stress) { return stress < *goal.stress_below; };
    if (goal.stress_above && !all_stresses(stresses, above)) return false;
    if (goal.stress_below && !all_stresses(stresses, below)) return false;
    // Grains that gravity has yet to bring together do not overlap.
    const bool in_flight = simulation.active_stage().gravity != Vec3{} &&
                           measurement.carried_share < rest_carried_share;
    return !goal.overlap || (!in_flight && measurement.deepest_overlap < *goal.overlap);
  };
  const auto has_passed = [&] {
    if (goal.strain && !(strain_since_start(watched, simulation, sample) >= *goal.strain)) {
      return false;
    }
    return !goal.void_ratio || (sample.enclosed && sample.void_ratio <= *goal.void_ratio);
  };
  return {.holds = holds(), .passed = has_passed()};
}

}  // namespace reckon
