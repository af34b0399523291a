// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/domain/grid_decomposition.hpp"

#include <algorithm>
#include <initializer_list>

namespace reckon {

void GridDecomposition::update(std::span<const Vec3> positions, std::span<const double> /*costs*/,
                               double reach, const Vec3& period) {
  period_ = period;
  Region domain = bounding_region(positions);
  for (int axis = 0; axis < 3; ++axis) {
    domain.low[axis] = -ranks_.max(-domain.low[axis]);
    domain.high[axis] = ranks_.max(domain.high[axis]);
    if (period[axis] > 0) {
      domain.low[axis] = 0;
      domain.high[axis] = period[axis];
    }
  }
  // The grid stays while the assembly stays within a bin of it: a new grid sends many grains to
  // other ranks.
  const double slack = reach_;
  // Bins may be wider than the reach, which changes with the speed of the fastest grain.
  bool keep = reach <= reach_ && reach >= 0.8 * reach_ && !domain_.empty();
  for (int axis = 0; axis < 3; ++axis) {
    keep = keep && domain.low[axis] > domain_.low[axis] - slack &&
           domain.low[axis] < domain_.low[axis] + slack &&
           domain.high[axis] < domain_.high[axis] + slack &&
           domain.high[axis] > domain_.high[axis] - slack &&
           (period[axis] == 0 || domain.high[axis] == domain_.high[axis]);
  }
  if (keep) return;
  domain_ = domain;
  reach_ = reach;
  cut_ = cut_grid(domain, ranks_.size(), reach);
}

GhostExchange::Sends border_layers(const GridCut& cut, int block, int axis,
                                   std::span<const BorderGrain> known, bool periodic) {
  GhostExchange::Sends sends;
  if (block >= cut.block_count()) return sends;
  const auto a = static_cast<std::size_t>(axis);
  const std::array<int, 3> place = cut.block_place(block);
  const int first = cut.first_bin(axis, place[a]);
  const int last = cut.first_bin(axis, place[a] + 1) - 1;
  const int count = cut.blocks[a];
  const auto add_neighbor = [&](int step, std::initializer_list<int> border_bins) {
    std::array<int, 3> neighbor = place;
    neighbor[a] += step;
    if (periodic && count > 1) neighbor[a] = (neighbor[a] + count) % count;
    if (neighbor[a] < 0 || neighbor[a] >= count) return;
    sends.peers.push_back(cut.block_at(neighbor));
    auto& indices = sends.indices.emplace_back();
    for (std::uint32_t n = 0; n < known.size(); ++n) {
      const int bin = cut.bin_of(axis, known[n].place[axis]);
      const auto is_bin = [bin](int border_bin) { return bin == border_bin; };
      if (std::any_of(border_bins.begin(), border_bins.end(), is_bin)) indices.push_back(n);
    }
  };
  if (periodic && count == 2) {  // one neighbour on both sides
    add_neighbor(+1, {first, last});
    return sends;
  }
  add_neighbor(-1, {first});
  add_neighbor(+1, {last});
  return sends;
}

std::unique_ptr<Ghosts> GridDecomposition::exchange_ghosts(std::vector<BorderGrain> owned) const {
  std::vector<GhostExchange::Choose> phases;
  phases.reserve(3);
  for (int axis = 0; axis < 3; ++axis) {
    phases.emplace_back([this, axis](std::span<const BorderGrain> known) {
      return border_layers(cut_, ranks_.rank(), axis, known, period_[axis] > 0);
    });
  }
  return std::make_unique<GhostExchange>(ranks_, std::move(owned), phases);
}

}  // namespace reckon
