// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What Simulation does with a periodic cell. Velocities are those of a grain's own way through
// space; what a grain does besides moving with the cell,
//
//   p = v - dH/dt H^-1 (x - centre)
//
// is what forces kick, damping slows and energies count. The cell's velocity goes in whole from one
// step to the next, to all grains alike: a change of rate sends no wave through the sample, and
// nothing depends on where the borders lie.
#include <fmt/format.h>

#include <algorithm>

#include "reckon/core/error.hpp"
#include "reckon/core/exact_sum.hpp"
#include "reckon/domain/packing.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/exact_totals.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {
namespace {

/// Of one pair, `d` being its branch.
CellReaction reaction_of(const PairForce& pair, const Vec3& d) {
  const Vec3& f = pair.force_on_a;
  const Vec3 squares = hadamard(d, d);
  return {{hadamard(f, d), f.x * d.y, f.x * d.z, f.y * d.z},
          double{pair.stiffness} * squares,
          double{pair.damping} * squares};
}

}  // namespace

/// The root's cell becomes everybody's.
void Simulation::restore_cell(const SimulationState& state) {
  if (!setup_.cell) return;
  const CellSetup& from = *setup_.cell;
  const UpperMat3 start{from.size, 0, 0, 0};
  cell_state_ = {.edges = start, .rates = {}, .edges_at_stage_start = start};
  if (state.cell) cell_state_ = *state.cell;
  Bytes bytes;
  if (distribution_.ranks().is_root()) pack(bytes, cell_state_);
  bytes = distribution_.ranks().broadcast(std::move(bytes));
  cell_state_ = Unpacker{bytes}.take<CellState>();
  cell_.emplace(from.center, from.periodic, cell_state_.edges, cell_state_.rates);
  adaptive_skin_.center = from.center;
  grain_contacts_.set_cell(*cell_, cell_motion());
}

void Simulation::begin_stage_of_cell() {
  cell_state_.edges_at_stage_start = cell_->edges();
  cell_state_.shear_at_stage_start = cell_state_.shear;
}

/// How the cell moved since contacts were evaluated. Pairs stay listed while they are at most twice
/// as far apart as when their lists were made (see skin_is_used_up).
CellMotion Simulation::cell_motion() const {
  return {cell_->center(), cell_since_evaluation_, 4 * (largest_radius_ + adaptive_skin_.max)};
}

void Simulation::require_wide_cell(double reach) const {
  const double width = cell_->least_width();
  if (width >= 2 * reach) return;
  throw Error{{.place = fmt::format("the cell, step {}", step_),
               .problem = fmt::format("it is {:.4g} m wide and must be {:.4g} m at least", width,
                                      2 * reach),
               .reason = "in a narrower one two grains could touch through two images at once",
               .fix = "Take a larger cell with more grains, or stop its compression earlier."}};
}

/// What a grain does besides moving with the cell; without a cell its velocity.
Vec3 Simulation::velocity_in_cell(std::size_t slot) const {
  const Vec3& velocity = grains_.velocity[slot];
  return cell_ ? velocity - cell_->velocity_at(grains_.position[slot]) : velocity;
}

CellReaction Simulation::cell_reaction() const {
  using Sums = std::array<ExactSum, 12>;
  std::vector<Sums> of_threads(static_cast<std::size_t>(thread_count()));
  const std::span<const PairForce> forces = grain_contacts_.forces();
  // A pair that two ranks share is told by the owner of its first grain: first each grain's share,
  // in the order of partners, then the exact sum of all.
  parallel_for(grains_.size(), 64, [&](std::size_t slot) {
    CellReaction own;
    for (const auto& entry : grain_contacts_.pairs_of_grain().of(slot)) {
      const PairForce& pair = forces[entry.pair];
      if (entry.is_a && pair.holds()) {
        own += reaction_of(pair, branch(grain_contacts_.pairs()[entry.pair]));
      }
    }
    const UpperMat3& v = own.virial;
    const std::array<double, 12> terms{v.diagonal.x,
                                       v.diagonal.y,
                                       v.diagonal.z,
                                       v.xy,
                                       v.xz,
                                       v.yz,
                                       own.stiffness.x,
                                       own.stiffness.y,
                                       own.stiffness.z,
                                       own.damping.x,
                                       own.damping.y,
                                       own.damping.z};
    Sums& sums = of_threads[static_cast<std::size_t>(thread_index())];
    for (std::size_t n = 0; n < terms.size(); ++n) {
      if (terms[n] != 0) sums[n].add(terms[n]);
    }
  });
  Sums& all = of_threads.front();
  for (std::size_t thread = 1; thread < of_threads.size(); ++thread) {
    for (std::size_t n = 0; n < all.size(); ++n) all[n].add(of_threads[thread][n]);
  }
  add_up(distribution_.ranks(), all);
  const auto value = [&all](std::size_t n) { return all[n].value(); };
  return {{{value(0), value(1), value(2)}, value(3), value(4), value(5)},
          {value(6), value(7), value(8)},
          {value(9), value(10), value(11)}};
}

/// Chooses how the cell goes on from what it feels at this step.
void Simulation::drive_cell() {
  const StageSetup* now = stage();
  const std::span<const CellControl> controls =
      now != nullptr ? std::span<const CellControl>{now->cell_controls}
                     : std::span<const CellControl>{};
  next_cell_ = cell_;
  const UpperMat3 last = cell_->gradient();
  if (controls.empty() && last == UpperMat3{}) {
    cell_gradient_ = {};
    cell_step_ = UpperMat3::identity();
    return;
  }
  const CellReaction reaction = cell_reaction();
  const double dt = setup_.time_step;
  cell_gradient_ = next_cell_->advance(rates_for(controls, reaction, *cell_, dt), dt);
  cell_step_ = UpperMat3::identity() + dt * cell_gradient_;
  cell_state_.work -= 0.5 * dt * contract(last + cell_gradient_, reaction.virial);
}

/// The work until this very step: half a step's is still to come.
double Simulation::cell_work_now() const {
  const UpperMat3 last = cell_->gradient();
  if (last == UpperMat3{}) return cell_state_.work;
  return cell_state_.work - 0.5 * setup_.time_step * contract(last, cell_reaction().virial);
}

/// What the cell does to a grain besides through contacts, from half a step before the next step to
/// half a step after: it stretches the motion `alone` of a grain against the cell, and lifts the
/// grain by `along`, its own velocity [J].
double Simulation::work_of_cell_on(std::size_t slot, const Vec3& alone, const Vec3& along) const {
  const double mass = inertias_[slot].mass;
  const Vec3 onward = grains_.velocity[slot] - next_cell_->velocity_at(grains_.position[slot]);
  return 0.5 * mass * (squared_norm(onward) - squared_norm(alone)) -
         mass * dot(setup_.body_force.gravity, along) * setup_.time_step;
}

void Simulation::move_cell() {
  cell_ = next_cell_;
  cell_state_.edges = cell_->edges();
  cell_state_.rates = cell_->rates();
  cell_state_.shear +=
      setup_.time_step * Vec3{cell_gradient_.xy, cell_gradient_.xz, cell_gradient_.yz};
  cell_since_evaluation_ = cell_step_ * cell_since_evaluation_;
  cell_since_lists_ = cell_step_ * cell_since_lists_;
}

}  // namespace reckon
