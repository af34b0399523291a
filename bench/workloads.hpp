// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "reckon/simulation/simulation.hpp"

namespace reckon::bench {

/// The requirements of a workload.
struct WorkloadRequest {
  bool small{false};            ///< a few grains and steps, for tests
  std::uint32_t grains{0};      ///< 0: the workload's own
  std::filesystem::path cache;  ///< folder that keeps packings; empty: nothing is kept
  ShapeStorage storage{ShapeStorage::full};
};

/// How it is to be measured.
enum class Course {
  steady,  ///< stretches of the engine's own steps, with a few plain steps from the state after
           ///< each
  whole    ///< both engines from the first step to rest
};

/// A state and what is to be run from it.
struct Workload {
  SimulationSetup setup;
  SimulationState state;
  Course course{Course::steady};
  std::uint64_t warm_up{1000};   ///< steps before the first measured
  std::uint64_t steps{200};      ///< of one stretch; of a whole run: between tests for rest
  std::uint64_t plain_steps{4};  ///< after each stretch
  int stretches{5};              ///< of a whole run: at most
  double rests_at{0};            ///< unbalanced ratio that ends a whole run; 0: never
  double inertial_number{0};     ///< 0: not in steady shear
  double solid_fraction{0};      ///< 0: not in a closed box
  std::size_t distinct_shapes{0};
  double paper_seconds{0};  ///< the paper's time for 1000 steps on one core; 0: none given [s]
};

struct WorkloadKind {
  std::string name;
  std::string meaning;
  std::uint32_t grains;        ///< by default
  std::uint32_t small_grains;  ///< for tests
  Workload (*make)(std::uint32_t grains, const WorkloadRequest& request);
};

/// All there are, in the order in which they are run.
[[nodiscard]] const std::vector<WorkloadKind>& workload_kinds();

/// Makes a workload; `name` is one of workload_kinds(), else Error.
[[nodiscard]] Workload make_workload(const std::string& name, const WorkloadRequest& request);

}  // namespace reckon::bench
