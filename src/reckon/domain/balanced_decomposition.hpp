// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/domain/decomposition.hpp"
#include "reckon/domain/regions.hpp"

namespace reckon {

/// Cuts space by recursive coordinate bisection (Zoltan), so that every part carries the same cost.
/// Returns one region per part; regions at the outside reach to infinity. Collective; every rank
/// returns the same regions. Without Zoltan it throws Error.
[[nodiscard]] std::vector<Region> bisect(const Communicator& ranks, std::span<const Vec3> positions,
                                         std::span<const double> costs, int parts);

/// Regions of equal cost, drawn again when the largest share of the cost exceeds the mean by more
/// than a threshold. Ghosts go straight to each rank whose region is within reach.
class BalancedDecomposition final : public Decomposition {
 public:
  explicit BalancedDecomposition(Communicator ranks) : ranks_{std::move(ranks)} {}

  void update(std::span<const Vec3> positions, std::span<const double> costs,
              double reach) override;
  [[nodiscard]] int owner_of(GrainId id, const Vec3& position) const override;
  [[nodiscard]] std::unique_ptr<Ghosts> exchange_ghosts(
      std::vector<BorderGrain> owned) const override;

 private:
  Communicator ranks_;
  std::vector<Region> regions_;
  double reach_{0};
};

}  // namespace reckon
