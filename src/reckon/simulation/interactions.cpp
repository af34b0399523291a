// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/interactions.hpp"

#include <utility>

namespace reckon {

Interactions::Interactions(const SimulationSetup& setup, const SimulationState& state)
    : grains_{setup.contact, setup.engine, setup.simd},
      walls_{setup.walls, setup.engine, setup.simd},
      membrane_{setup.engine} {
  grains_.adopt(state.pair_springs);
  grains_.adopt(state.broken_bonds);
  walls_.adopt(state.wall_springs);
}

void Interactions::set_friction(double between_grains, std::span<const double> on_walls) {
  grains_.set_friction(between_grains);
  walls_.set_friction(on_walls);
}

void Interactions::rebuild(std::vector<Pair> pairs, std::span<const GrainFrame> frames,
                           std::size_t owned, const AdaptiveSkin& skin) {
  grains_.rebuild(std::move(pairs), frames.size(), owned);
  walls_.rebuild(frames.first(owned), skin);
  membrane_.forget();
}

}  // namespace reckon
