// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// What Simulation does with a membrane. All ranks hold all of it; each finds the touches of its own
// grains, and all ranks add up all touches in the same order.
#include <algorithm>
#include <limits>

#include "reckon/boundary/membrane_side.hpp"
#include "reckon/core/error.hpp"
#include "reckon/domain/packing.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {
namespace {

/// The touches of all ranks, on all ranks.
std::vector<MembraneTouch> share(const Communicator& ranks, std::vector<MembraneTouch> own) {
  if (ranks.size() == 1) return own;
  Bytes bytes;
  pack<MembraneTouch>(bytes, own);
  std::vector<MembraneTouch> all;
  const auto to_all = std::vector<Bytes>(static_cast<std::size_t>(ranks.size()), bytes);
  for (const Bytes& part : ranks.all_to_all(to_all)) {
    const auto touches = Unpacker{part}.take_all<MembraneTouch>();
    all.insert(all.end(), touches.begin(), touches.end());
  }
  return all;
}

}  // namespace

/// The root's membrane becomes everybody's.
void Simulation::take_over_membrane(const SimulationState& state) {
  if (!setup_.membrane) return;
  membrane_.emplace(*setup_.membrane);
  const Communicator& ranks = distribution_.ranks();
  Bytes bytes;
  if (ranks.is_root()) {
    const MembraneState& from = state.membrane;
    pack(bytes, from.start);
    pack(bytes, from.floor);
    pack(bytes, from.lid);
    pack(bytes, from.floor_start);
    pack(bytes, from.lid_start);
    pack<MembraneNode>(bytes, from.nodes);
    pack<MembraneSpring>(bytes, from.springs);
    pack(bytes, from.pressure_before);
    pack(bytes, from.volume_at_stage_start);
    pack(bytes, from.height_at_stage_start);
  }
  bytes = ranks.broadcast(std::move(bytes));
  Unpacker message{bytes};
  MembraneState taken;
  taken.start = message.take<CylinderPlace>();
  taken.floor = message.take<WallId>();
  taken.lid = message.take<WallId>();
  taken.floor_start = message.take<Vec3>();
  taken.lid_start = message.take<Vec3>();
  taken.nodes = message.take_all<MembraneNode>();
  taken.springs = message.take_all<MembraneSpring>();
  taken.pressure_before = message.take<double>();
  taken.volume_at_stage_start = message.take<double>();
  taken.height_at_stage_start = message.take<double>();
  const std::size_t walls = setup_.walls.size();
  if (taken.in_place() && (taken.floor.get() >= walls || taken.lid.get() >= walls)) {
    throw Error{{.place = "the state to go on from",
                 .problem = "its membrane ends at walls that the scene does not have",
                 .reason = {},
                 .fix = "Go on with the scene that it came from."}};
  }
  membrane_->adopt(std::move(taken));
  if (membrane_->in_place()) wall_contacts_.remove(setup_.membrane->mould);
}

/// The mould goes, with what its contacts store.
void Simulation::let_membrane_take_place() {
  const WallId mould = setup_.membrane->mould;
  const auto poses = poses_at(setup_.walls, driven_walls_, step_, setup_.time_step);
  const auto closed = closed_cylinder(setup_.walls, poses, mould);
  if (!closed) {
    throw Error{{.place = "the membrane",
                 .problem = "its mould no longer closes off a space",
                 .reason = "planes have passed each other or are not at right angles to it",
                 .fix = "Keep one plane at each end of the mould, at right angles to its axis."}};
  }
  for (std::size_t c = 0; c < wall_contacts_.forces().size(); ++c) {
    const auto& candidate = wall_contacts_.candidates()[c];
    if (candidate.wall != mould) continue;
    grains_.ledger[candidate.slot].wall_work -= wall_contacts_.forces()[c].elastic;
  }
  wall_contacts_.remove(mould);
  lists_are_stale_ = true;
  membrane_->take_place(closed->place, closed->floor, closed->lid, poses);
}

/// At the current step; a new membrane comes with the whole pressure, since its mould held the
/// sample before.
double Simulation::membrane_pressure() const {
  const MembranePressure& wanted = *stage()->membrane;
  const double since = static_cast<double>(step_ - stage_starts_.back()) * setup_.time_step;
  const bool is_new = stage_starts_.size() < 2 || !setup_.stages[stage_starts_.size() - 2].membrane;
  if (is_new || !(since < wanted.ramp)) return wanted.pressure;
  const double before = membrane_->state().pressure_before;
  return before + (wanted.pressure - before) * (since / wanted.ramp);
}

void Simulation::evaluate_membrane() {
  if (membrane() == nullptr) return;
  membrane_contacts_.evaluate(*membrane_, owned_frames(), grain_contacts_.displacements(),
                              setup_.time_step);
  membrane_->evaluate(share(distribution_.ranks(), membrane_contacts_.touches()),
                      membrane_pressure());
}

std::optional<GrainOutside> Simulation::grain_outside_membrane() const {
  if (membrane() == nullptr) return std::nullopt;
  constexpr double none = -std::numeric_limits<double>::infinity();
  const MembraneSide side{*membrane_};
  const auto rank_of = [](GrainId id) {
    return -static_cast<double>(id.get());
  };  // the lowest wins
  const Communicator& ranks = distribution_.ranks();
  const double found = ranks.max(parallel_max(grains_.size(), none, [&](std::size_t slot) {
    const bool out = grains_.prescribed[slot] == 0 && side.is_outside(grains_.position[slot]);
    return out ? rank_of(grains_.id[slot]) : none;
  }));
  if (found == none) return std::nullopt;
  Vec3 position{none, none, none};
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) {
    if (rank_of(grains_.id[slot]) == found) position = grains_.position[slot];
  }
  for (int axis = 0; axis < 3; ++axis) position[axis] = ranks.max(position[axis]);
  return GrainOutside{GrainId{static_cast<std::uint32_t>(-found)}, position};
}

}  // namespace reckon
