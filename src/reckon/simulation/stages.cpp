// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/error.hpp"
#include "reckon/domain/packing.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {

/// The stages of the root's state become those of all ranks. A new run begins its first stage.
void Simulation::restore_stages(const SimulationState& state) {
  const Communicator& ranks = distribution_.ranks();
  Bytes bytes;
  if (ranks.is_root()) pack<std::uint64_t>(bytes, state.stage_starts);
  bytes = ranks.broadcast(std::move(bytes));
  stage_starts_ = Unpacker{bytes}.take_all<std::uint64_t>();
  if (stage_starts_.size() > setup_.stages.size()) {
    throw Error{{.place = "the state to go on from",
                 .problem = "it has other stages than the scene",
                 .reason = {},
                 .fix = "Go on with the scene that it came from."}};
  }
  const bool begins = !setup_.stages.empty() && stage_starts_.empty();
  if (begins) stage_starts_ = {step_};
  apply_stage();
  if (begins) set_bonds();
}

void Simulation::apply_stage() {
  const StageSetup* now = stage();
  if (now == nullptr) return;
  interactions_.set_friction(now->friction, now->wall_friction);
  active_ = {now->gravity, now->damping};
  if (now->membrane && membrane() == nullptr) replace_mould();
}

void Simulation::begin_next_stage() {
  const Vec3 gravity_before = active_.gravity;
  if (setup_.membrane) {  // what it, or its mould, holds at this very step
    update();
    compute_forces();
  }
  container_.begin_stage(membrane() != nullptr ? membrane_pressure() : 0);
  stage_starts_.push_back(step_);
  apply_stage();
  set_bonds();
  // Turning gravity lifts or drops every grain's potential: someone's work.
  const Vec3 turned = active_.gravity - gravity_before;
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
  update();
  compute_forces();
  interactions_.set_bonds(frames_);
}

/// The mould goes, with what its contacts store.
void Simulation::replace_mould() {
  const WallId mould = setup_.membrane->mould;
  container_.replace_mould(step_);
  interactions_.visit_stored_on_wall(
      mould, [&](std::size_t slot, double stored) { grains_.ledger[slot].wall_work -= stored; });
  interactions_.remove_wall(mould);
  lists_are_stale_ = true;
}

/// At the current step; a new membrane comes with the whole pressure, since its mould held the
/// sample before.
double Simulation::membrane_pressure() const {
  const MembranePressure& wanted = *stage()->membrane;
  const double since = static_cast<double>(step_ - stage_starts_.back()) * setup_.time_step;
  const bool is_new = stage_starts_.size() < 2 || !setup_.stages[stage_starts_.size() - 2].membrane;
  if (is_new || !(since < wanted.ramp)) return wanted.pressure;
  const double before = membrane()->state().pressure_before;
  return before + (wanted.pressure - before) * (since / wanted.ramp);
}

}  // namespace reckon
