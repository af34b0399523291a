// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reckon/avatar/library_file.hpp"
#include "reckon/simulation/config.hpp"
#include "reckon/simulation/simulation.hpp"
#include "reckon/simulation/time_step.hpp"

namespace reckon {

/// A scene with everything that its files hold but the shapes' grids and nodes: what io hands over.
struct LoadedScene {
  SceneConfig config;
  std::vector<ShapeSummary> shapes;     ///< of all [[grains]] tables, one after another
  ShapeStore::Read read_shape;          ///< brings the rest of a shape
  std::vector<GrainState> grains;       ///< as placed, sorted by id, at rest or as set
  std::vector<Vec3> own_accelerations;  ///< by grain id; empty: none [m/s^2]
  std::vector<std::string> warnings;    ///< what may make results wrong, a sentence each
};

/// A scene made ready to run.
struct PreparedScene {
  SimulationSetup setup;
  SimulationState initial;
  TimeStepChoice time_step;
  std::uint64_t steps{0};  ///< how many to run from the start; with stages, at most
};

/// All planes of the scene's outflows; a grain leaves when its centre is behind one.
[[nodiscard]] std::vector<PlaneSurface> outflow_planes(const SceneConfig& scene);

/// The walls of a scene; boxes are six of them, or five.
[[nodiscard]] std::vector<Wall> make_walls(const SceneConfig& scene);

/// By axis.
[[nodiscard]] std::array<bool, 3> periodic_axes(const CellConfig& cell);
/// The cement of a scene, if it has some.
[[nodiscard]] std::optional<BondLaw> make_bond_law(const SceneConfig& scene);

/// The membrane of a scene whose mould is one of the walls. Its mass, and what the scene leaves
/// open of its stiffness and damping, follow from the time step.
[[nodiscard]] std::optional<MembraneSetup> make_membrane(const SceneConfig& scene,
                                                         std::span<const Wall> walls,
                                                         double time_step);

/// Turns config into walls, laws and a time step. `scene.config` is already validated. Collective:
/// all ranks pass the same scene, but only the root's grains count.
[[nodiscard]] PreparedScene prepare(const LoadedScene& scene, const Communicator& ranks = {});

}  // namespace reckon
