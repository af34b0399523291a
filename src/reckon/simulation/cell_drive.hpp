// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include "reckon/boundary/cell_control.hpp"
#include "reckon/contact/displacement_bound.hpp"
#include "reckon/grains/periodic_cell.hpp"
#include "reckon/simulation/simulation_setup.hpp"

namespace reckon {

/// A periodic cell that deforms as controls ask, the same on all ranks.
///
/// The velocity of a grain is that through space, unwrapped. Forces, damping and energies see the
/// velocity relative to the cell,
///
///   p = v - dH/dt H^-1 (x - centre)
///
/// A change of the rate of the cell changes the velocities of all grains at once. It therefore
/// sends no wave through the sample, and nothing depends on where the borders of the cell are.
class CellDrive {
 public:
  CellDrive(const CellSetup& setup, const CellState& state);
  [[nodiscard]] static CellState state_at_start(const CellSetup& setup);

  [[nodiscard]] const PeriodicCell& cell() const { return cell_; }
  [[nodiscard]] const CellState& state() const { return state_; }

  void begin_stage();

  /// Whether the cell deforms now, or may under these controls: then drive() needs the reaction.
  [[nodiscard]] bool may_move(std::span<const CellControl> controls) const;
  [[nodiscard]] bool is_moving() const { return cell_.gradient() != UpperMat3{}; }
  /// Sets the rates for the step to come.
  void drive(std::span<const CellControl> controls, const CellReaction& reaction, double time_step);
  /// The same where nothing moves.
  void stand_still();
  /// Deforms the cell by one step.
  void advance(double time_step);

  /// The velocity of the cell over the step to come, at a point [m/s].
  [[nodiscard]] Vec3 drift_velocity(const Vec3& position) const {
    return gradient_ * (position - cell_.center());
  }
  /// What the cell does to a grain apart from contacts, from half a step before the end of the step
  /// to come to half a step after it: it stretches the motion of the grain relative to the cell,
  /// and lifts the grain [J]. `relative`: relative velocity before the cell moves; `from` and `to`:
  /// the position before and after; `velocity`: through space, after.
  [[nodiscard]] double work_on(double mass, const Vec3& gravity, const Vec3& from, const Vec3& to,
                               const Vec3& relative, const Vec3& velocity, double time_step) const;
  /// Work on the grains through contacts until this very step; `reaction` as of this step [J].
  [[nodiscard]] double work_until_now(const CellReaction& reaction, double time_step) const;

  /// How the cell has moved since contacts were evaluated, and since lists were made. `farthest`:
  /// no two grains that may touch are farther apart [m].
  [[nodiscard]] CellMotion since_evaluation(double farthest) const {
    return {cell_.center(), since_evaluation_, farthest};
  }
  /// Until the end of the step to come.
  [[nodiscard]] CellMotion next_since_lists(double farthest) const {
    return {cell_.center(), deformation_ * since_lists_, farthest};
  }
  void mark_evaluation() { since_evaluation_ = UpperMat3::identity(); }
  void mark_lists() { since_lists_ = UpperMat3::identity(); }

  /// Throws Error where two grains closer than `reach` [m] could touch through two images at once.
  void require_width(double reach, std::uint64_t step) const;

 private:
  CellState state_;
  PeriodicCell cell_;
  PeriodicCell next_;                                  // after the step to come
  UpperMat3 gradient_;                                 // of the velocity over that step [1/s]
  UpperMat3 deformation_{UpperMat3::identity()};       // over that step
  UpperMat3 since_evaluation_{UpperMat3::identity()};  // deformation
  UpperMat3 since_lists_{UpperMat3::identity()};       // likewise
};

}  // namespace reckon
