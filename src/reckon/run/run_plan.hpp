// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reckon/run/overlap_forecast.hpp"
#include "reckon/run/stage_plan.hpp"
#include "reckon/scene/node_spacing.hpp"
#include "reckon/simulation/setup.hpp"

namespace reckon {

/// The plan of a run, as far as it is known before it.
struct RunPlan {
  std::uint64_t grains{0};
  std::uint64_t shapes{0};  ///< in the library
  std::uint64_t shapes_in_use{0};
  std::uint64_t nodes{0};       ///< of all grains
  std::uint64_t walls{0};       ///< a box counts as its planes
  double smallest_diameter{0};  ///< of bounding spheres in use [m]
  double largest_diameter{0};   ///< [m]
  double solid_mass{0};         ///< [kg]
  double density_scaling{1};    ///< see MaterialConfig

  std::optional<CoarseNodes> coarse_nodes;  ///< see scene/node_spacing.hpp

  std::uint64_t membrane_nodes{0};  ///< for its mould at the start
  std::optional<Vec3> cell_size;    ///< of a periodic cell [m]
  std::string cell_axes;            ///< along which it is periodic, e.g. "xyz"
  double cell_solid_fraction{0};    ///< volume of grains over that of the cell
  double membrane_areal_mass{0};    ///< required by the time step [kg/m^2]

  double bin_edge{0};  ///< [m]
  std::uint64_t occupied_bins{0};
  std::uint64_t listed_pairs{0};  ///< at the start
  std::uint64_t contacts{0};      ///< touching pairs at the start, walls included
  double deepest_overlap{0};      ///< of a node at the start [m]

  TimeStepChoice time_step;
  double step_fraction{0};
  std::string limiting_shape;  ///< of the grain that limits the time step
  std::vector<StagePlan> stages;
  std::optional<OverlapForecast> overlap;  ///< where a load is known
  std::uint64_t steps{0};                  ///< with stages, at most
  double simulated_time{0};                ///< [s]

  std::uint64_t memory_shapes{0};    ///< [bytes]
  std::uint64_t memory_grains{0};    ///< with pair lists and springs [bytes]
  std::uint64_t memory_surfaces{0};  ///< of one file of output.surfaces [bytes]
  std::uint64_t history_rows{0};
  std::uint64_t frames{0};
  std::uint64_t checkpoints{0};
  std::uint64_t output_bytes{0};  ///< estimate of the run folder

  int threads{1};
  std::uint64_t timed_steps{0};       ///< number of steps made in memory to measure the speed
  double seconds_per_step{0};         ///< wall clock
  double output_seconds{0};           ///< estimate for the whole run
  double duration{0};                 ///< estimate for the whole run [s]
  std::vector<std::string> warnings;  ///< see LoadedScene
  std::optional<std::string> trial_failure;  ///< what went wrong in the timed steps
};

/// Plans a run and times it: makes steps in memory for about `timing_seconds` and writes nothing.
[[nodiscard]] RunPlan plan_run(const LoadedScene& scene, double timing_seconds);

/// The plan as a table for people.
[[nodiscard]] std::string plan_text(const RunPlan& plan);
/// Of a time step that is_too_long().
[[nodiscard]] std::string too_long_text(const TimeStepChoice& step);

/// The plan as JSON; `valid` and the scene's name go in front.
[[nodiscard]] std::string plan_json(const RunPlan& plan);

}  // namespace reckon
