// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/cell_drive.hpp"

#include <fmt/format.h>

#include "reckon/core/error.hpp"

namespace reckon {

CellState CellDrive::state_at_start(const CellSetup& setup) {
  const UpperMat3 start{setup.size, 0, 0, 0};
  return {.edges = start, .rates = {}, .edges_at_stage_start = start};
}

CellDrive::CellDrive(const CellSetup& setup, const CellState& state)
    : state_{state}, cell_{setup.center, setup.periodic, state.edges, state.rates}, next_{cell_} {}

void CellDrive::begin_stage() {
  state_.edges_at_stage_start = cell_.edges();
  state_.shear_at_stage_start = state_.shear;
}

bool CellDrive::may_move(std::span<const CellControl> controls) const {
  return !controls.empty() || is_moving();
}

void CellDrive::drive(std::span<const CellControl> controls, const CellReaction& reaction,
                      double time_step) {
  const UpperMat3 last = cell_.gradient();
  next_ = cell_;
  gradient_ = next_.advance(rates_for(controls, reaction, cell_, time_step), time_step);
  deformation_ = UpperMat3::identity() + time_step * gradient_;
  state_.work -= 0.5 * time_step * contract(last + gradient_, reaction.virial);
}

void CellDrive::stand_still() {
  next_ = cell_;
  gradient_ = {};
  deformation_ = UpperMat3::identity();
}

void CellDrive::advance(double time_step) {
  cell_ = next_;
  state_.edges = cell_.edges();
  state_.rates = cell_.rates();
  state_.shear += time_step * Vec3{gradient_.xy, gradient_.xz, gradient_.yz};
  since_evaluation_ = deformation_ * since_evaluation_;
  since_lists_ = deformation_ * since_lists_;
}

double CellDrive::work_on(double mass, const Vec3& gravity, const Vec3& from, const Vec3& to,
                          const Vec3& relative, const Vec3& velocity, double time_step) const {
  const Vec3 onward = velocity - next_.velocity_at(to);
  return 0.5 * mass * (squared_norm(onward) - squared_norm(relative)) -
         mass * dot(gravity, drift_velocity(from)) * time_step;
}

double CellDrive::work_until_now(const CellReaction& reaction, double time_step) const {
  // drive() adds the work of this step together with that of half the step to come.
  return state_.work - 0.5 * time_step * contract(cell_.gradient(), reaction.virial);
}

void CellDrive::require_width(double reach, std::uint64_t step) const {
  const double width = cell_.least_width();
  if (width >= 2 * reach) return;
  throw Error{{.place = fmt::format("the cell, step {}", step),
               .problem = fmt::format("it is {:.4g} m wide and must be {:.4g} m at least", width,
                                      2 * reach),
               .reason = "in a narrower one two grains could touch through two images at once",
               .fix = "Take a larger cell with more grains, or stop its compression earlier."}};
}

}  // namespace reckon
