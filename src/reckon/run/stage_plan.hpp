// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reckon/simulation/setup.hpp"

namespace reckon {

/// The plan of a stage, as far as it is known before the run.
struct StagePlan {
  std::string name;
  std::uint64_t most_steps{0};
  std::string controls;  ///< in words
  bool has_goal{false};
  /// Where planes move at a rate of strain and the stress around them is known from this stage or
  /// the last one that holds one.
  struct Pace {
    double rate{0};             ///< the fastest [1/s]
    double stress{0};           ///< [Pa]
    double inertial_number{0};  ///< that the rate makes at the stress
    double advised_rate{0};     ///< that makes quasi_static_inertial_number [1/s]
  };
  std::optional<Pace> pace;
};

[[nodiscard]] std::vector<StagePlan> plan_stages(const LoadedScene& scene, double time_step);

/// A paragraph per stage, for people.
[[nodiscard]] std::vector<std::string> stage_lines(const StagePlan& plan, double time_step);

}  // namespace reckon
