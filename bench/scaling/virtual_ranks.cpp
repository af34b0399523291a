// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "virtual_ranks.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

#include "reckon/domain/balanced_decomposition.hpp"
#include "reckon/domain/grid_decomposition.hpp"
#include "reckon/neighbor/block_bins.hpp"
#include "reckon/neighbor/grain_costs.hpp"

namespace reckon::bench {
namespace {

/// A grain that a rank holds: its number in the assembly is its id and shape.
struct VirtualRank {
  std::vector<BorderGrain> known;  ///< owned grains, then ghosts
  std::size_t owned{0};
  std::uint64_t sent{0};
  std::uint64_t messages{0};
};

using Stage = std::function<GhostExchange::Sends(int rank, std::span<const BorderGrain> known)>;

/// Everything that a decomposition decides, for all ranks at once.
struct Sharing {
  std::function<int(const Vec3&)> owner_of;
  std::vector<Stage> stages;
  std::function<std::vector<Pair>(int rank, std::span<const GrainId> ids,
                                  std::span<const Vec3> positions, std::span<const double> radii,
                                  std::size_t owned)>
      find_pairs;
};

Sharing share_by_grid(const Assembly& assembly, int ranks) {
  const GridCut cut = cut_grid(assembly.domain, ranks, assembly.reach);
  Sharing sharing;
  sharing.owner_of = [cut](const Vec3& p) { return cut.owner_of(p); };
  for (int axis = 0; axis < 3; ++axis) {
    sharing.stages.emplace_back([cut, axis](int rank, std::span<const BorderGrain> known) {
      return border_layers(cut, rank, axis, known);
    });
  }
  sharing.find_pairs = [cut, skin = assembly.skin](int rank, auto ids, auto positions, auto radii,
                                                   std::size_t owned) {
    return BlockBins{cut, rank, positions, owned}.pairs_by_grain(ids, positions, radii, skin);
  };
  return sharing;
}

Sharing share_by_cost(const Assembly& assembly, std::span<const double> costs, int ranks) {
  std::vector<Region> regions(1);
  if (ranks > 1) regions = bisect(Communicator{}, assembly.positions, costs, ranks);
  Sharing sharing;
  sharing.owner_of = [regions](const Vec3& p) { return region_holding(regions, p, 0); };
  sharing.stages.emplace_back(
      [regions, reach = assembly.reach](int rank, std::span<const BorderGrain> known) {
        return sends_within_reach(regions, rank, reach, known);
      });
  sharing.find_pairs = [skin = assembly.skin](int /*rank*/, auto ids, auto positions, auto radii,
                                              std::size_t owned) {
    return reckon::find_pairs(ids, positions, radii, skin, owned);
  };
  return sharing;
}

/// What GhostExchange does between ranks, without messages.
void exchange(const std::vector<Stage>& stages, std::vector<VirtualRank>& ranks) {
  for (const Stage& stage : stages) {
    std::vector<std::vector<BorderGrain>> incoming(ranks.size());
    for (std::size_t r = 0; r < ranks.size(); ++r) {
      VirtualRank& rank = ranks[r];
      const GhostExchange::Sends sends = stage(static_cast<int>(r), rank.known);
      for (std::size_t k = 0; k < sends.peers.size(); ++k) {
        const auto& indices = sends.indices[k];
        rank.sent += indices.size();
        rank.messages += indices.empty() ? 0U : 1U;
        auto& inbox = incoming[static_cast<std::size_t>(sends.peers[k])];
        for (const std::uint32_t index : indices) inbox.push_back(rank.known[index]);
      }
    }
    for (std::size_t r = 0; r < ranks.size(); ++r) {
      ranks[r].known.insert(ranks[r].known.end(), incoming[r].begin(), incoming[r].end());
    }
  }
}

/// One rank's load; writes the costs of its grains to their places in `costs`.
RankLoad load_of(int number, const VirtualRank& rank, const Assembly& assembly,
                 const Sharing& sharing, std::vector<double>& costs) {
  RankLoad load;
  load.grains = rank.owned;
  load.ghosts = rank.known.size() - rank.owned;
  load.bytes = rank.sent * sizeof(GhostState);
  load.messages = rank.messages;
  if (rank.owned == 0) return load;
  std::vector<GrainId> ids;
  std::vector<Vec3> positions;
  std::vector<double> radii;
  for (const BorderGrain& grain : rank.known) {
    ids.push_back(grain.id);
    positions.push_back(grain.state.position);
    radii.push_back(assembly.radii[grain.id.get()]);
  }
  const std::vector<Pair> pairs = sharing.find_pairs(number, ids, positions, radii, rank.owned);
  load.pairs = pairs.size();
  load.cross_pairs =
      static_cast<std::uint64_t>(std::count_if(pairs.begin(), pairs.end(), [&](const Pair& pair) {
        return pair.slot_a >= rank.owned || pair.slot_b >= rank.owned;
      }));
  const std::vector<double> own_costs = grain_costs(pairs, rank.owned);
  for (std::size_t n = 0; n < rank.owned; ++n) {
    load.work += own_costs[n];
    costs[ids[n].get()] = own_costs[n];
  }
  return load;
}

/// Gives every grain to its owner, exchanges ghosts, lists pairs; writes the costs of the grains.
std::vector<RankLoad> count_loads(const Assembly& assembly, const Sharing& sharing, int ranks,
                                  std::vector<double>& costs) {
  std::vector<VirtualRank> virtual_ranks(static_cast<std::size_t>(ranks));
  for (std::uint32_t n = 0; n < assembly.positions.size(); ++n) {
    BorderGrain grain{GrainId{n}, ShapeId{}, {}};
    grain.state.position = grain.place = assembly.positions[n];
    const auto owner = static_cast<std::size_t>(sharing.owner_of(grain.state.position));
    virtual_ranks[owner].known.push_back(grain);
  }
  for (VirtualRank& rank : virtual_ranks) rank.owned = rank.known.size();
  exchange(sharing.stages, virtual_ranks);
  std::vector<RankLoad> loads;
  loads.reserve(static_cast<std::size_t>(ranks));
  for (int rank = 0; rank < ranks; ++rank) {
    loads.push_back(
        load_of(rank, virtual_ranks[static_cast<std::size_t>(rank)], assembly, sharing, costs));
  }
  return loads;
}

}  // namespace

std::vector<RankLoad> share_out(const Assembly& assembly, DecompositionKind kind, int ranks) {
  std::vector<double> costs(assembly.positions.size(), 1.0);
  if (kind == DecompositionKind::grid) {
    return count_loads(assembly, share_by_grid(assembly, ranks), ranks, costs);
  }
  constexpr int most_listings = 5;  // with few grains a rank there may be no even cut
  std::vector<RankLoad> loads;
  for (int listing = 0; listing < most_listings; ++listing) {
    loads = count_loads(assembly, share_by_cost(assembly, costs, ranks), ranks, costs);
    if (summarize(loads).work_ratio <= most_imbalance) break;
  }
  return loads;
}

LoadSummary summarize(const std::vector<RankLoad>& loads) {
  LoadSummary summary;
  const auto ranks = static_cast<double>(loads.size());
  double work = 0;
  std::uint64_t grains = 0;
  std::uint64_t pairs = 0;
  std::uint64_t cross = 0;
  std::uint64_t ghosts = 0;
  for (const RankLoad& load : loads) {
    work += load.work;
    summary.most_work = std::max(summary.most_work, load.work);
    grains += load.grains;
    pairs += load.pairs;
    cross += load.cross_pairs;
    ghosts += load.ghosts;
    summary.most_grains = std::max(summary.most_grains, load.grains);
    summary.most_pairs = std::max(summary.most_pairs, load.pairs);
    summary.most_ghosts = std::max(summary.most_ghosts, load.ghosts);
    summary.most_bytes = std::max(summary.most_bytes, load.bytes);
    summary.most_messages = std::max(summary.most_messages, load.messages);
    summary.idle_ranks += load.grains == 0 ? 1U : 0U;
  }
  summary.pairs = pairs - cross / 2;
  summary.ghosts_per_rank = static_cast<double>(ghosts) / ranks;
  if (summary.pairs > 0) {
    summary.computed_twice = 0.5 * static_cast<double>(cross) / static_cast<double>(summary.pairs);
  }
  if (summary.most_work > 0) {
    summary.work_ratio = summary.most_work * ranks / work;
    summary.speed_up = static_cast<double>(grains + summary.pairs) / summary.most_work;
  }
  return summary;
}

}  // namespace reckon::bench
