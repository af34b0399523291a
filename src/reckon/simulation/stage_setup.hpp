// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "reckon/avatar/library_file.hpp"
#include "reckon/simulation/config.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {

/// The planes that a control's `wall` names, grouped as they move together: one plane, two sides of
/// a box, or all six as three pairs. None when there are no such.
[[nodiscard]] std::vector<std::vector<WallId>> planes_named(std::span<const Wall> walls,
                                                            std::string_view name);

/// What of a periodic cell a control's `wall` names: "cell.x" ... "cell.yz" one component, "cell"
/// all three edges. None when it does not name a part of the cell.
[[nodiscard]] std::vector<CellAxis> cell_axes_named(std::string_view name);

/// What a stage moves by strain rate or speed: the control with the largest value. None when the
/// stage drives nothing.
[[nodiscard]] const ControlConfig* driven_control(const StageConfig& stage);

/// The volume-weighted mean diameter of spheres as large as the grains [m].
[[nodiscard]] double mean_diameter(std::span<const GrainState> grains,
                                   std::span<const ShapeSummary> shapes);

/// The rate of strain that gives this inertial number at a mean stress [Pa]: I / (d sqrt(rho / p))
/// [1/s].
[[nodiscard]] double rate_at(double inertial_number, double stress, double diameter,
                             double density);

/// What a servo may use unless the scene says otherwise.
constexpr double servo_inertial_number = 0.01;

/// Fills in the limits of the servos' rates that the scene leaves open.
void resolve_rate_limits(SceneConfig& scene, std::span<const GrainState> grains,
                         std::span<const ShapeSummary> shapes);

/// The stages of a scene whose controls all name planes or parts of the cell.
[[nodiscard]] std::vector<StageSetup> make_stages(const SceneConfig& scene,
                                                  std::span<const Wall> walls);

/// How many steps a stage takes at most.
[[nodiscard]] std::uint64_t most_steps(const StageConfig& stage, double time_step);

}  // namespace reckon
