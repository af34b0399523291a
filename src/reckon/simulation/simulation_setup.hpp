// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "reckon/boundary/cell_control.hpp"
#include "reckon/boundary/membrane.hpp"
#include "reckon/boundary/wall_control.hpp"
#include "reckon/contact/contact_settings.hpp"
#include "reckon/contact/simd_level.hpp"
#include "reckon/domain/decomposition.hpp"
#include "reckon/domain/shape_store.hpp"
#include "reckon/motion/body_force.hpp"

namespace reckon {

/// The pressure around a membrane during a stage.
struct MembranePressure {
  double pressure{0};  ///< [Pa]
  double ramp{0};      ///< how long it takes to get there [s]
};

/// The axis that a test is about: that of the walls, or of the part of the cell, that a stage
/// drives.
struct DrivenAxis {
  Vec3 normal_unit{0, 0, 1};
  std::vector<WallId> walls;       ///< that are driven along it; none in a periodic cell
  std::optional<CellAxis> cell{};  ///< of a periodic cell; may be a shear
};

/// What holds for one stage of a test.
struct StageSetup {
  std::string name;
  double friction{0};                 ///< between grains
  std::vector<double> wall_friction;  ///< by wall
  Vec3 gravity;                       ///< [m/s^2]
  double damping{0};                  ///< global damping xi [1/s]
  std::vector<WallControl> controls;
  std::vector<CellControl> cell_controls;
  /// Of the stage before that drives something, or the next one; z if none does.
  DrivenAxis axis;
  std::optional<MembranePressure> membrane;  ///< none: not in place yet
  bool sets_bonds{false};                    ///< at its start, where grains touch
};

/// A periodic cell at the start.
struct CellSetup {
  Vec3 center;                                     ///< stays where it is [m]
  std::array<bool, 3> periodic{true, true, true};  ///< by axis
  Vec3 size;                                       ///< edges, along the axes [m]
};

/// What stays the same from the first step to the last.
struct SimulationSetup {
  ShapeStore shapes;
  double density{0};  ///< [kg/m^3]
  ContactSettings contact;
  std::vector<Wall> walls;
  std::optional<MembraneSetup> membrane;  ///< takes its place with the first stage that has it
  std::optional<CellSetup> cell;
  std::vector<PlaneSurface> outflows;  ///< a grain whose centre is behind one leaves
  BodyForce body_force;
  double damping{0};    ///< global damping xi [1/s]
  double time_step{0};  ///< [s]
  /// What takes turns: a stage sets friction, gravity and damping anew. Empty: no stages.
  std::vector<StageSetup> stages;
  double skin{0};  ///< of the pair lists (AdaptiveSkin); changes the speed, never the answer [m]
  ContactEngine engine{ContactEngine::near};                     ///< likewise
  SimdLevel simd{SimdLevel::automatic};                          ///< likewise
  DecompositionKind decomposition{DecompositionKind::balanced};  ///< likewise
};

}  // namespace reckon
