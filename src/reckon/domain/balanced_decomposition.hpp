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

/// What the rank of regions[own] sends: to each rank whose region is within `reach` of its own, the
/// grains within `reach` of that region. See Decomposition::update for `period`.
[[nodiscard]] GhostExchange::Sends sends_within_reach(std::span<const Region> regions, int own,
                                                      double reach,
                                                      std::span<const BorderGrain> known,
                                                      const Vec3& period = {});

/// Largest cost of a rank / mean cost, beyond which regions are drawn again.
inline constexpr double most_imbalance = 1.10;

/// Regions of equal cost, drawn again when the costs have become too uneven. Ghosts go straight to
/// each rank whose region is within reach.
class BalancedDecomposition final : public Decomposition {
 public:
  explicit BalancedDecomposition(Communicator ranks) : ranks_{std::move(ranks)} {}

  void update(std::span<const Vec3> positions, std::span<const double> costs, double reach,
              const Vec3& period) override;
  [[nodiscard]] int owner_of(GrainId id, const Vec3& position) const override;
  [[nodiscard]] std::unique_ptr<Ghosts> exchange_ghosts(
      std::vector<BorderGrain> owned) const override;

 private:
  Communicator ranks_;
  std::vector<Region> regions_;
  double reach_{0};
  Vec3 period_;
};

}  // namespace reckon
