// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reckon/simulation/simulation.hpp"

namespace reckon::bench {

/// A state and what is to be run from it.
struct Workload {
  SimulationSetup setup;
  SimulationState state;
  double inertial_number{0};  ///< 0: not in steady shear
  double solid_fraction{0};
  std::uint64_t whole_run{0};  ///< steps from start to end; 0: measure a steady state
};

struct WorkloadKind {
  std::string name;
  std::string meaning;
  std::uint32_t grains;  ///< by default
  Workload (*make)(std::uint32_t grains, const std::string& packing_file);
};

[[nodiscard]] const std::vector<WorkloadKind>& workload_kinds();

}  // namespace reckon::bench
