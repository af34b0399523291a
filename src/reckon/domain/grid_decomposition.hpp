// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/domain/decomposition.hpp"
#include "reckon/domain/regions.hpp"

namespace reckon {

/// What block `block` sends in the phase along `axis`: to its lower and upper neighbour the grains
/// in its first and last layer of bins, with those that earlier phases brought there. Where the
/// axis is `periodic`, the first and the last block are neighbours.
[[nodiscard]] GhostExchange::Sends border_layers(const GridCut& cut, int block, int axis,
                                                 std::span<const BorderGrain> known,
                                                 bool periodic = false);

/// The paper's decomposition: equal blocks of whole bins, one block a rank, a padding layer of bins
/// around each, filled in three phases. x first; y then also passes on what x brought, and z what
/// both brought, so that edges and corners need no messages of their own (paper, section 5.3):
///
///     phase x            phase y
///     . . . . .          g o o o g   <- from the upper neighbour, its x ghosts included
///     g o o o g          g o o o g
///     g o o o g          g o o o g
///     . . . . .          g o o o g   <- from the lower neighbour
///
/// Blocks at the outside are unbounded until the grid is regenerated (paper, section 3.4).
class GridDecomposition final : public Decomposition {
 public:
  explicit GridDecomposition(Communicator ranks) : ranks_{std::move(ranks)} {}

  void update(std::span<const Vec3> positions, std::span<const double> costs, double reach,
              const Vec3& period) override;
  [[nodiscard]] int owner_of(GrainId /*id*/, const Vec3& position) const override {
    return cut_.owner_of(position);
  }
  [[nodiscard]] std::unique_ptr<Ghosts> exchange_ghosts(
      std::vector<BorderGrain> owned) const override;

  [[nodiscard]] const GridCut& cut() const { return cut_; }

 private:
  Communicator ranks_;
  GridCut cut_;
  Region domain_;
  double reach_{0};
  Vec3 period_;
};

}  // namespace reckon
