// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/domain/balanced_decomposition.hpp"

#include <cmath>

namespace reckon {
namespace {

/// This rank's cost as a share of the mean, the largest over all ranks.
double imbalance(const Communicator& ranks, std::span<const double> costs) {
  double own = 0;
  for (const double cost : costs) own += cost;
  // Costs are small whole numbers or nearly so; a fixed-point sum is the same on every rank.
  std::int64_t total = std::llround(own * 1024);
  ranks.sum({&total, 1});
  if (total == 0) return 1;
  return ranks.max(own) * ranks.size() / (static_cast<double>(total) / 1024);
}

}  // namespace

void BalancedDecomposition::update(std::span<const Vec3> positions, std::span<const double> costs,
                                   double reach, const Vec3& period) {
  reach_ = reach;
  period_ = period;
  if (ranks_.size() == 1) {
    regions_.assign(1, Region{});
    return;
  }
  if (!regions_.empty() && imbalance(ranks_, costs) <= most_imbalance) return;
  regions_ = bisect(ranks_, positions, costs, ranks_.size());
}

int BalancedDecomposition::owner_of(GrainId /*id*/, const Vec3& position) const {
  return region_holding(regions_, position, ranks_.rank());
}

GhostExchange::Sends sends_within_reach(std::span<const Region> regions, int own, double reach,
                                        std::span<const BorderGrain> known, const Vec3& period) {
  GhostExchange::Sends sends;
  const Region& home = regions[static_cast<std::size_t>(own)];
  for (int rank = 0; rank < static_cast<int>(regions.size()); ++rank) {
    const Region& other = regions[static_cast<std::size_t>(rank)];
    if (rank == own) continue;
    // Both ranks test in the same order, so their answers are equal to the last bit.
    const bool near =
        rank < own ? other.within(home, reach, period) : home.within(other, reach, period);
    if (!near) continue;
    sends.peers.push_back(rank);
    auto& indices = sends.indices.emplace_back();
    for (std::uint32_t n = 0; n < known.size(); ++n) {
      if (other.squared_distance(known[n].place, period) <= reach * reach) indices.push_back(n);
    }
  }
  return sends;
}

std::unique_ptr<Ghosts> BalancedDecomposition::exchange_ghosts(
    std::vector<BorderGrain> owned) const {
  const GhostExchange::Choose to_all_within_reach = [this](std::span<const BorderGrain> known) {
    return sends_within_reach(regions_, ranks_.rank(), reach_, known, period_);
  };
  return std::make_unique<GhostExchange>(ranks_, std::move(owned),
                                         std::span{&to_all_within_reach, 1});
}

}  // namespace reckon
