// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reckon/boundary/enclosure.hpp"
#include "reckon/boundary/membrane.hpp"
#include "reckon/boundary/wall.hpp"
#include "reckon/boundary/wall_control.hpp"
#include "reckon/parallel/communicator.hpp"
#include "reckon/simulation/cell_drive.hpp"
#include "reckon/simulation/simulation_setup.hpp"
#include "reckon/simulation/simulation_state.hpp"

namespace reckon {

/// What holds the sample and how it moves: walls, a membrane, a periodic cell. The same on all
/// ranks. The order of a step:
///
///   place()                        for the current step
///   load_membrane()                when contacts are known
///   drive_cell()  drive_walls()    by the controls of the stage
///   advance()
class Container {
 public:
  /// The state of the root counts. Collective. Throws Error if it does not fit the setup.
  Container(const SimulationSetup& setup, const SimulationState& state, const Communicator& ranks);

  /// Places walls, and the ends of the membrane, for one step.
  void place(std::uint64_t step);
  /// As of place().
  [[nodiscard]] std::span<const WallPose> poses() const { return poses_; }
  /// Where the walls are at any step, with today's driven walls.
  [[nodiscard]] std::vector<WallPose> poses_at_step(std::uint64_t step) const {
    return poses_at(walls_, driven_walls_, step, time_step_);
  }

  [[nodiscard]] std::span<const Wall> walls() const { return walls_; }
  /// What controls have made of the walls.
  [[nodiscard]] std::span<const DrivenWall> driven_walls() const { return driven_walls_; }
  /// The membrane where it has replaced its mould, else nothing.
  [[nodiscard]] const Membrane* membrane() const {
    return membrane_ && membrane_->in_place() ? &*membrane_ : nullptr;
  }
  [[nodiscard]] const CellDrive* cell_drive() const { return cell_ ? &*cell_ : nullptr; }
  /// The periodic cell as of the current step, else nothing.
  [[nodiscard]] const PeriodicCell* cell() const { return cell_ ? &cell_->cell() : nullptr; }

  /// From b to a, in a periodic cell from the image of b that is nearest to a [m].
  [[nodiscard]] Vec3 branch(const Vec3& a, const Vec3& b) const {
    return cell_ ? cell()->branch(a, b) : a - b;
  }
  /// The image of a point in the cell, without a cell the point itself [m].
  [[nodiscard]] Vec3 wrapped(const Vec3& point) const {
    return cell_ ? cell()->wrapped(point) : point;
  }
  /// The velocity relative to the cell, without a cell the velocity itself [m/s].
  [[nodiscard]] Vec3 relative_velocity(const Vec3& position, const Vec3& velocity) const {
    return cell_ ? velocity - cell()->velocity_at(position) : velocity;
  }
  /// Whether a wall bounds the sample: a mould that the membrane has replaced does not.
  [[nodiscard]] bool is_in_place(WallId wall) const {
    return membrane() == nullptr || membrane_->setup().mould != wall;
  }

  /// The space that walls, or walls and membrane, or a cell that is periodic along all axes,
  /// enclose: as of the last evaluation, where the stage began at `stage_start`, and at step 0,
  /// where the membrane is still its mould. Nothing if they enclose none, or its volume is not
  /// known.
  [[nodiscard]] std::optional<Enclosure> space() const;
  [[nodiscard]] std::optional<Enclosure> space_at_stage_start(std::uint64_t stage_start) const;
  [[nodiscard]] std::optional<Enclosure> space_at_start() const;

  /// A stage begins; the pressure of the one before, where a membrane is in place, was this [Pa].
  void begin_stage(double pressure_before);
  /// The membrane takes the place of its mould. Throws Error if no space is enclosed.
  void replace_mould(std::uint64_t step);

  /// Forces on the membrane, if it is in place; `touches` of this rank. Collective.
  void load_membrane(std::vector<MembraneTouch> touches, double pressure,
                     const Communicator& ranks);
  /// Sets the rates of the cell, if there is one, for the step to come. `reaction` returns that of
  /// the grains on the cell; it is called if the cell moves. `stage`: none without stages.
  template <class Reaction>
  void drive_cell(const StageSetup* stage, Reaction&& reaction);
  /// Moves controlled walls on by one step. `reactions` returns those of the grains on all walls;
  /// it is called if a control holds a stress. Throws Error if a control needs a space and none is
  /// enclosed.
  template <class Reactions>
  void drive_walls(const StageSetup& stage, Reactions&& reactions);
  /// Moves the cell and the membrane on by one step.
  void advance();

  /// Throws Error where two grains closer than `reach` [m] could touch through two images of the
  /// cell at once.
  void require_width(double reach, std::uint64_t step) const {
    if (cell_) cell_->require_width(reach, step);
  }
  /// Contacts are evaluated now, and lists are made now: CellDrive counts its motion from here.
  void mark_evaluation() {
    if (cell_) cell_->mark_evaluation();
  }
  void mark_lists() {
    if (cell_) cell_->mark_lists();
  }

  /// Writes its parts of the state.
  void save(SimulationState& state) const;

 private:
  void restore_walls(const SimulationState& state, const Communicator& ranks);
  void restore_membrane(const SimulationSetup& setup, const SimulationState& state,
                        const Communicator& ranks);
  void restore_cell(const SimulationSetup& setup, const SimulationState& state,
                    const Communicator& ranks);
  void move_walls(const StageSetup& stage, std::span<const WallReaction> reactions);

  std::vector<Wall> walls_;
  std::optional<CellSetup> cell_setup_;
  double time_step_;
  std::vector<DrivenWall> driven_walls_;
  std::vector<WallPose> poses_;
  std::optional<Membrane> membrane_;
  std::optional<CellDrive> cell_;
};

template <class Reaction>
void Container::drive_cell(const StageSetup* stage, Reaction&& reaction) {
  if (!cell_) return;
  const auto controls =
      stage != nullptr ? std::span{stage->cell_controls} : std::span<const CellControl>{};
  if (cell_->may_move(controls)) {
    cell_->drive(controls, reaction(), time_step_);
  } else {
    cell_->stand_still();
  }
}

template <class Reactions>
void Container::drive_walls(const StageSetup& stage, Reactions&& reactions) {
  const bool holds_stress =
      std::any_of(stage.controls.begin(), stage.controls.end(),
                  [](const WallControl& c) { return c.target == WallTarget::stress; });
  move_walls(stage, holds_stress ? reactions() : std::vector<WallReaction>(walls_.size()));
}

}  // namespace reckon
