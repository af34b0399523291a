// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <span>

#include "reckon/avatar/library_file.hpp"
#include "reckon/core/id.hpp"
#include "reckon/grains/grains.hpp"
#include "reckon/simulation/config.hpp"

namespace reckon {

/// A time step and what decided it.
struct TimeStepChoice {
  double step{0};       ///< [s]
  bool given{false};    ///< true: the scene says so; the rest tells what the rule would look at
  GrainId limiting;     ///< the grain with the smallest sqrt(m / k)
  double mass{0};       ///< its mass [kg]
  double stiffness{0};  ///< the stiffness that its contacts may reach [N/m]
  double rule_step{0};  ///< step_fraction * sqrt(mass / stiffness) [s]

  /// Above this, forces may grow without bound [s].
  [[nodiscard]] double longest() const { return std::sqrt(mass / stiffness); }
  [[nodiscard]] bool is_too_long() const { return given && step > longest(); }
};

/// step_fraction * sqrt(m / k), the smallest over all grains, with k the stiffness that a contact
/// really has. Law `area`: the stiffness of a node times a twentieth of the surface, as a sphere
/// has that overlaps by a tenth of its radius. Law `linear`: times a twentieth of the nodes, or,
/// where there are no walls, times node_cap. The stiffness of a node is the largest of the normal
/// and shear stiffnesses of grains and walls. Law `hertz`: 2 E* a on a wall, with a twentieth of
/// the surface in touch.
[[nodiscard]] TimeStepChoice choose_time_step(const SceneConfig& scene,
                                              std::span<const GrainState> grains,
                                              std::span<const ShapeSummary> shapes);

}  // namespace reckon
