// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "reckon/boundary/membrane.hpp"
#include "reckon/boundary/wall_contacts.hpp"
#include "reckon/contact/grain_contacts.hpp"
#include "reckon/grains/grains.hpp"
#include "reckon/grains/periodic_cell.hpp"

namespace reckon {

/// A grain that an outflow took out, as it was then.
struct DepartedGrain {
  std::uint64_t step{0};
  GrainState grain;

  friend bool operator==(const DepartedGrain&, const DepartedGrain&) = default;
};

/// What changes: all that a checkpoint must hold to go on to the same bits.
struct SimulationState {
  std::uint64_t step{0};
  std::vector<GrainState> grains;         ///< sorted by id
  std::vector<PairSprings> pair_springs;  ///< sorted by ids
  std::vector<WallSprings> wall_springs;  ///< sorted by grain, then wall
  std::vector<DepartedGrain> departed;    ///< sorted by id
  std::vector<DrivenWall> driven_walls;   ///< by wall; empty at the start
  /// The step at which each stage so far began; the last is under way. Empty without stages, and
  /// at the start.
  std::vector<std::uint64_t> stage_starts;
  MembraneState membrane;
  std::optional<CellState> cell;  ///< none at the start
  BrokenBonds broken_bonds;

  friend bool operator==(const SimulationState&, const SimulationState&) = default;
};

}  // namespace reckon
