// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/container.hpp"

#include <algorithm>

#include "reckon/core/error.hpp"
#include "reckon/domain/packing.hpp"

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

/// The space of a cell that is periodic along all axes, or nothing.
std::optional<Enclosure> inside(const PeriodicCell& cell, const UpperMat3& edges,
                                std::size_t walls) {
  if (!cell.is_closed()) return std::nullopt;
  const Vec3& size = edges.diagonal;
  return Enclosure{size.x * size.y * size.z, cell.center() - 0.5 * size, cell.center() + 0.5 * size,
                   std::vector<double>(walls, 0)};
}

}  // namespace

Container::Container(const SimulationSetup& setup, const SimulationState& state,
                     const Communicator& ranks)
    : walls_{setup.walls}, cell_setup_{setup.cell}, time_step_{setup.time_step} {
  restore_walls(state, ranks);
  restore_membrane(setup, state, ranks);
  restore_cell(setup, state, ranks);
}

void Container::restore_walls(const SimulationState& state, const Communicator& ranks) {
  Bytes bytes;
  if (ranks.is_root()) pack<DrivenWall>(bytes, state.driven_walls);
  bytes = ranks.broadcast(std::move(bytes));
  driven_walls_ = Unpacker{bytes}.take_all<DrivenWall>();
  if (!driven_walls_.empty() && driven_walls_.size() != walls_.size()) {
    throw Error{{.place = "the state to go on from",
                 .problem = "it has other walls than the scene",
                 .reason = {},
                 .fix = "Go on with the scene that it came from."}};
  }
  driven_walls_.resize(walls_.size());
}

void Container::restore_membrane(const SimulationSetup& setup, const SimulationState& state,
                                 const Communicator& ranks) {
  if (!setup.membrane) return;
  membrane_.emplace(*setup.membrane);
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
  const std::size_t walls = walls_.size();
  if (taken.in_place() && (taken.floor.get() >= walls || taken.lid.get() >= walls)) {
    throw Error{{.place = "the state to go on from",
                 .problem = "its membrane ends at walls that the scene does not have",
                 .reason = {},
                 .fix = "Go on with the scene that it came from."}};
  }
  membrane_->adopt(std::move(taken));
}

void Container::restore_cell(const SimulationSetup& setup, const SimulationState& state,
                             const Communicator& ranks) {
  if (!setup.cell) return;
  Bytes bytes;
  if (ranks.is_root()) pack(bytes, state.cell.value_or(CellDrive::state_at_start(*setup.cell)));
  bytes = ranks.broadcast(std::move(bytes));
  cell_.emplace(*setup.cell, Unpacker{bytes}.take<CellState>());
}

void Container::save(SimulationState& state) const {
  state.driven_walls = driven_walls_;
  if (membrane() != nullptr) state.membrane = membrane_->state();
  if (cell_) state.cell = cell_->state();
}

void Container::place(std::uint64_t step) {
  poses_ = poses_at_step(step);
  if (membrane() != nullptr) membrane_->follow(poses_);
}

void Container::begin_stage(double pressure_before) {
  if (membrane() != nullptr) membrane_->begin_stage(pressure_before);
  for (DrivenWall& wall : driven_walls_) wall.displacement_at_stage_start = wall.displacement;
  if (cell_) cell_->begin_stage();
}

void Container::replace_mould(std::uint64_t step) {
  const auto poses = poses_at_step(step);
  const auto closed = closed_cylinder(walls_, poses, membrane_->setup().mould);
  if (!closed) {
    throw Error{{.place = "the membrane",
                 .problem = "its mould no longer closes off a space",
                 .reason = "planes have passed each other or are not at right angles to it",
                 .fix = "Keep one plane at each end of the mould, at right angles to its axis."}};
  }
  membrane_->take_place(closed->place, closed->floor, closed->lid, poses);
}

void Container::load_membrane(std::vector<MembraneTouch> touches, double pressure,
                              const Communicator& ranks) {
  membrane_->evaluate(share(ranks, std::move(touches)), pressure);
}

void Container::move_walls(const StageSetup& stage, std::span<const WallReaction> reactions) {
  const auto needs_space = [](const WallControl& control) {
    return control.target != WallTarget::speed;
  };
  Enclosure enclosed;
  if (std::any_of(stage.controls.begin(), stage.controls.end(), needs_space)) {
    const std::optional<Enclosure> now = space();
    if (!now || !(now->volume > 0)) {
      throw Error{{.place = "stage " + stage.name,
                   .problem = "the walls no longer close off a space",
                   .reason = "controlled planes have passed each other, as they do when grains "
                             "cannot hold the stress, or none are between them",
                   .fix = "Lower the stress or the rates, or start with more grains."}};
    }
    enclosed = *now;
  }
  reckon::advance(stage.controls, walls_, reactions, enclosed, time_step_, driven_walls_);
}

void Container::advance() {
  if (cell_) cell_->advance(time_step_);
  if (membrane() != nullptr) membrane_->advance(time_step_);
}

std::optional<Enclosure> Container::space() const {
  if (membrane() != nullptr) return membrane_->enclosure(walls_.size());
  if (cell_) return inside(cell_->cell(), cell_->cell().edges(), walls_.size());
  return enclosure_of(walls_, poses_);
}

std::optional<Enclosure> Container::space_at_stage_start(std::uint64_t stage_start) const {
  if (membrane() != nullptr) return membrane_->enclosure_at_stage_start(walls_.size());
  if (cell_) return inside(cell_->cell(), cell_->state().edges_at_stage_start, walls_.size());
  std::vector<DrivenWall> then = driven_walls_;
  for (DrivenWall& wall : then) wall = {wall.displacement_at_stage_start, {}, {}};
  return enclosure_of(walls_, poses_at(walls_, then, stage_start, time_step_));
}

std::optional<Enclosure> Container::space_at_start() const {
  if (cell_) return inside(cell_->cell(), UpperMat3{cell_setup_->size, 0, 0, 0}, walls_.size());
  return enclosure_of(walls_, poses_at(walls_, {}, 0, time_step_));
}

}  // namespace reckon
