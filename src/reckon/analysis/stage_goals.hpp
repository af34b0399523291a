// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "reckon/analysis/sample.hpp"
#include "reckon/simulation/config.hpp"

namespace reckon {

/// The state of the conditions of a goal at one step.
struct GoalState {
  /// What an instant can meet by accident: rest, stresses, overlaps. It must last.
  bool holds{true};
  bool passed{true};  ///< what a stage moves towards: strain and void ratio
};

/// Tests the goal of the current stage. The measurements are those of the current step. Collective;
/// the same on all ranks.
[[nodiscard]] GoalState look_at(const StageGoal& goal, const Simulation& simulation,
                                const Measurement& measurement, const SampleMeasurement& sample);

/// For how many times 2 pi sqrt(m / k) of the grain that limits the time step rest, held stresses
/// and overlaps must last; and a stress that is passed on the way, as in a cycle.
constexpr double rest_periods = 5;
constexpr double passing_periods = 1;

/// For how many such periods a goal must be met; 0 where none of its parts has to last.
[[nodiscard]] double periods_of(const StageGoal& goal);

/// A condition that counts once it has held for a span of steps, at each step at which it was
/// looked at. The step since when it holds is part of a checkpoint, so that a resumed run ends
/// where an uninterrupted one does.
class HeldCondition {
 public:
  explicit HeldCondition(std::optional<std::uint64_t> since) : since_{since} {}

  /// Returns whether it has held for so many steps, one at least.
  bool look(std::uint64_t step, bool holds, std::uint64_t span);
  void forget() { since_.reset(); }
  [[nodiscard]] std::optional<std::uint64_t> since() const { return since_; }

 private:
  std::optional<std::uint64_t> since_;
};

}  // namespace reckon
