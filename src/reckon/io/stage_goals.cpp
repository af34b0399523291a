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

/// The first part of the cell that is moved by a strain rate.
const CellControl* driven_part(const StageSetup& stage) {
  for (const CellControl& control : stage.cell_controls) {
    if (control.target != WallTarget::stress) return &control;
  }
  return nullptr;
}

double strain_of(const CellControl& control, const CellState& state,
                 const SampleMeasurement& sample) {
  if (!is_shear(control.axis)) return sample.strain[static_cast<int>(control.axis)];
  const Vec3 shear = state.shear - state.shear_at_stage_start;
  return shear[static_cast<int>(control.axis) - static_cast<int>(CellAxis::xy)];
}

/// The largest along driven planes, or of an axis if there are none.
double strain_since_start(const Simulation& simulation, const SampleMeasurement& sample) {
  const StageSetup& stage = *simulation.stage();
  if (driven_part(stage) != nullptr) {
    double largest = 0;
    for (const CellControl& control : stage.cell_controls) {
      if (control.target == WallTarget::stress) continue;
      const double strain = strain_of(control, simulation.cell_state(), sample);
      largest = std::max(largest, std::abs(strain));
    }
    return largest;
  }
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
  const auto compare = [&result](double stress, double target) {
    const double lacking = std::abs(stress - target);
    result.largest_error = std::max(result.largest_error, target > 0 ? lacking / target : lacking);
  };
  const StageSetup& stage = *simulation.stage();
  if (!stage.cell_controls.empty()) {
    const CellReaction reaction = simulation.cell_reaction();
    for (const CellControl& control : stage.cell_controls) {
      const double stress = stress_of(control.axis, reaction, *simulation.cell());
      if (control.target == WallTarget::stress) compare(stress, control.value);
      if (&control == driven_part(stage)) {
        // Grains resist shear against its direction.
        result.driven = is_shear(control.axis) && control.value > 0 ? -stress : stress;
      }
    }
    if (stage.controls.empty()) return result;
  }
  const auto space = simulation.space();
  const std::vector<WallReaction> reactions = simulation.wall_reactions();
  if (!space) return {std::numeric_limits<double>::infinity(), result.driven};
  for (const WallControl& control : stage.controls) {
    const double stress = stress_on(control, reactions, *space);
    if (control.target == WallTarget::stress) {
      compare(stress, control.value);
    } else if (&control == driven_planes(stage)) {
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
  if (goal.overlap && !(measurement.deepest_overlap < *goal.overlap)) return false;
  if (goal.void_ratio && !(sample.enclosed && sample.void_ratio <= *goal.void_ratio)) return false;
  return true;
}

}  // namespace reckon
