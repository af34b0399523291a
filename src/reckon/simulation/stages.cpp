// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "reckon/core/error.hpp"
#include "reckon/core/exact_sum.hpp"
#include "reckon/domain/packing.hpp"
#include "reckon/simulation/exact_totals.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {
namespace {

/// A cell that closes its space off, or nothing.
std::optional<Enclosure> inside(const PeriodicCell& cell, const UpperMat3& edges,
                                std::size_t walls) {
  if (!cell.is_closed()) return std::nullopt;
  const Vec3& size = edges.diagonal;
  return Enclosure{size.x * size.y * size.z, cell.center() - 0.5 * size, cell.center() + 0.5 * size,
                   std::vector<double>(walls, 0)};
}

}  // namespace

/// The root's walls and stages become everybody's.
bool Simulation::take_over_walls_and_stages(const SimulationState& state) {
  const Communicator& ranks = distribution_.ranks();
  Bytes bytes;
  if (ranks.is_root()) {
    pack<DrivenWall>(bytes, state.driven_walls);
    pack<std::uint64_t>(bytes, state.stage_starts);
  }
  bytes = ranks.broadcast(std::move(bytes));
  Unpacker message{bytes};
  driven_walls_ = message.take_all<DrivenWall>();
  stage_starts_ = message.take_all<std::uint64_t>();
  const bool fits = (driven_walls_.empty() || driven_walls_.size() == setup_.walls.size()) &&
                    stage_starts_.size() <= setup_.stages.size();
  if (!fits) {
    throw Error{{.place = "the state to go on from",
                 .problem = "it has other walls or stages than the scene",
                 .reason = {},
                 .fix = "Go on with the scene that it came from."}};
  }
  driven_walls_.resize(setup_.walls.size());
  const bool begins = !setup_.stages.empty() && stage_starts_.empty();
  if (begins) stage_starts_ = {step_};
  apply_stage();
  return begins;
}

void Simulation::apply_stage() {
  const StageSetup* now = stage();
  if (now == nullptr) return;
  grain_contacts_.set_friction(now->friction);
  wall_contacts_.set_friction(now->wall_friction);
  setup_.body_force.gravity = now->gravity;
  setup_.damping = now->damping;
  if (now->membrane && membrane() == nullptr) let_membrane_take_place();
}

void Simulation::begin_next_stage() {
  const Vec3 gravity_before = setup_.body_force.gravity;
  if (membrane_) {  // what it, or its mould, holds at this very step
    bring_up_to_date();
    evaluate_contacts();
  }
  if (membrane() != nullptr) membrane_->begin_stage(membrane_pressure());
  stage_starts_.push_back(step_);
  for (DrivenWall& wall : driven_walls_) wall.displacement_at_stage_start = wall.displacement;
  if (cell_) begin_stage_of_cell();
  apply_stage();
  set_bonds();
  // Turning gravity lifts or drops every grain's potential: someone's work.
  const Vec3 turned = setup_.body_force.gravity - gravity_before;
  if (turned == Vec3{}) return;
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) {
    grains_.ledger[slot].body_work -= mass(slot) * dot(turned, grains_.position[slot]);
  }
  for (DepartedGrain& gone : departed_) {
    const double mass = setup_.density * shapes_[gone.grain.shape.get()].mass.volume;
    gone.grain.ledger.body_work -= mass * dot(turned, gone.grain.position);
  }
}

/// Where the stage that begins wants them, and grains touch at this very step.
void Simulation::set_bonds() {
  if (stage() == nullptr || !stage()->sets_bonds) return;
  bring_up_to_date();
  evaluate_contacts();
  grain_contacts_.set_bonds(frames_);
}

std::optional<Enclosure> Simulation::space() const {
  if (membrane() != nullptr) return membrane_->enclosure(setup_.walls.size());
  if (cell_) return inside(*cell_, cell_->edges(), setup_.walls.size());
  return enclosure_of(setup_.walls, wall_contacts_.poses());
}

std::optional<Enclosure> Simulation::space_at_stage_start() const {
  if (membrane() != nullptr) return membrane_->enclosure_at_stage_start(setup_.walls.size());
  if (cell_) return inside(*cell_, cell_state_.edges_at_stage_start, setup_.walls.size());
  std::vector<DrivenWall> then = driven_walls_;
  for (DrivenWall& wall : then) wall = {wall.displacement_at_stage_start, {}, {}};
  const std::uint64_t start = stage_starts_.empty() ? 0 : stage_starts_.back();
  return enclosure_of(setup_.walls, poses_at(setup_.walls, then, start, setup_.time_step));
}

std::optional<Enclosure> Simulation::space_at_start() const {
  const std::size_t walls = setup_.walls.size();
  if (cell_) return inside(*cell_, UpperMat3{setup_.cell->size, 0, 0, 0}, walls);
  return enclosure_of(setup_.walls, poses_at(setup_.walls, {}, 0, setup_.time_step));
}

std::vector<WallReaction> Simulation::wall_reactions() const {
  const std::size_t walls = setup_.walls.size();
  std::vector<ExactSum> sums(3 * walls);  // forces, then stiffnesses, then dashpots
  for (std::size_t c = 0; c < wall_contacts_.candidates().size(); ++c) {
    const WallForce& contact = wall_contacts_.forces()[c];
    if (contact.touching == 0) continue;
    const std::size_t wall = wall_contacts_.candidates()[c].wall.get();
    const auto* plane = std::get_if<PlaneSurface>(&setup_.walls[wall].surface);
    if (plane == nullptr) continue;  // no control moves it
    sums[wall].add(dot(contact.force, plane->normal_unit));
    sums[walls + wall].add(contact.stiffness);
    sums[2 * walls + wall].add(contact.damping);
  }
  add_up(distribution_.ranks(), sums);
  std::vector<WallReaction> reactions;
  for (std::size_t w = 0; w < walls; ++w) {
    reactions.push_back({sums[w].value(), sums[walls + w].value(), sums[2 * walls + w].value()});
  }
  return reactions;
}

/// Controlled walls go on from what they feel at this step.
void Simulation::advance_walls() {
  const StageSetup* now = stage();
  if (now == nullptr) return;
  const auto is = [](WallTarget target) {
    return [target](const WallControl& control) { return control.target == target; };
  };
  std::vector<WallReaction> reactions(setup_.walls.size());
  if (std::any_of(now->controls.begin(), now->controls.end(), is(WallTarget::stress))) {
    reactions = wall_reactions();
  }
  std::optional<Enclosure> space;
  if (!std::all_of(now->controls.begin(), now->controls.end(), is(WallTarget::speed))) {
    space = this->space();
    if (!space || !(space->volume > 0)) {
      throw Error{{.place = "stage " + now->name,
                   .problem = "the walls no longer close off a space",
                   .reason = "controlled planes have passed each other, as they do when grains "
                             "cannot hold the stress, or none are between them",
                   .fix = "Lower the stress or the rates, or start with more grains."}};
    }
  }
  advance(now->controls, setup_.walls, reactions, space.value_or(Enclosure{}), setup_.time_step,
          driven_walls_);
}

}  // namespace reckon
