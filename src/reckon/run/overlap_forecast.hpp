// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "reckon/results/run_verdict.hpp"
#include "reckon/simulation/setup.hpp"

namespace reckon {

/// How deep grains will overlap under the largest load that a scene gives them.
struct OverlapForecast {
  double stress{0};       ///< [Pa]
  bool of_weight{false};  ///< the stress is that under the grains' own weight
  double ratio{0};        ///< overlap of an average contact / mean diameter

  [[nodiscard]] bool is_too_deep() const { return !(ratio <= overlap_limit); }
};

/// From stress over stiffness, for equal spheres of the mean diameter d: an average contact carries
/// F = stress d^2. Two such spheres that overlap by u press on each other, by the law of the scene,
/// with
///
///   area     pi/4 k_n d u^2                 hertz    4/3 E* sqrt(d/4) u^(3/2)
///   linear   as area, with k_n over the area of a node; beyond node_cap, k_n node_cap u/2
///
/// Nothing for a scene without a stress and without gravity.
[[nodiscard]] std::optional<OverlapForecast> forecast_overlap(const LoadedScene& scene);

/// The forecast in words.
[[nodiscard]] std::string overlap_line(const OverlapForecast& forecast);

}  // namespace reckon
