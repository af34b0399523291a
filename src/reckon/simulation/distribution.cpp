// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/distribution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "reckon/core/error.hpp"
#include "reckon/core/exact_sum.hpp"
#include "reckon/domain/grid_decomposition.hpp"
#include "reckon/domain/packing.hpp"
#include "reckon/neighbor/block_bins.hpp"

namespace reckon {
namespace {

GhostState ghost_state(const Grains& grains, std::size_t slot) {
  return {grains.position[slot], grains.orientation[slot], grains.velocity[slot],
          grains.angular_velocity_body[slot]};
}

void pack_springs(Bytes& bytes, const PairSprings& pair) {
  pack(bytes, pair.id_a);
  pack(bytes, pair.id_b);
  pack<NodeSpring>(bytes, pair.springs);
  pack<Bond>(bytes, std::span{pair.bond ? &*pair.bond : nullptr, pair.bond ? 1U : 0U});
}

void pack_springs(Bytes& bytes, const WallSprings& entry) {
  pack(bytes, entry.grain);
  pack(bytes, entry.wall);
  pack<NodeSpring>(bytes, entry.springs);
}

/// Sums over all grains of all ranks that migration must not change, to the last bit. Per unit of
/// density.
struct Stock {
  double mass{0};
  Vec3 momentum;
  friend bool operator==(const Stock&, const Stock&) = default;
};

Stock take_stock(const Communicator& ranks, const Grains& grains,
                 std::span<const ShapeView> shapes) {
  std::array<ExactSum, 4> sums;
  for (std::size_t slot = 0; slot < grains.size(); ++slot) {
    const double mass = shapes[grains.shape[slot].get()].mass.volume;
    const Vec3 momentum = mass * grains.velocity[slot];
    sums[0].add(mass);
    sums[1].add(momentum.x);
    sums[2].add(momentum.y);
    sums[3].add(momentum.z);
  }
  for (ExactSum& sum : sums) {
    sum.carry();
    ranks.sum(sum.digits());
  }
  return {sums[0].value(), {sums[1].value(), sums[2].value(), sums[3].value()}};
}

void require(bool kept, const std::string& reason) {
  if (kept) return;
  throw Error{{.problem = "grains were lost or changed on their way between ranks",
               .reason = reason,
               .fix = "This is a fault of the program: please report it with the scene."}};
}

Grains without_leaving(const Grains& grains, std::span<const int> owners, int rank) {
  Grains staying;
  for (std::size_t slot = 0; slot < grains.size(); ++slot) {
    if (owners[slot] == rank) staying.push_back(grains.state(slot));
  }
  return staying;
}

}  // namespace

Distribution::Distribution(const Communicator& ranks, DecompositionKind kind,
                           std::size_t grain_count, std::size_t id_count)
    : ranks_{ranks},
      kind_{kind},
      grain_count_{grain_count},
      decomposition_{make_decomposition(kind, ranks, id_count)} {}

/// Message to one rank: its new grains; then their pair springs; then their wall springs.
std::vector<Bytes> Distribution::pack_leaving(const Grains& grains, std::span<const int> owners,
                                              const GrainContacts& grain_contacts,
                                              const WallContacts& wall_contacts) {
  const auto rank_count = static_cast<std::size_t>(ranks_.size());
  std::vector<std::vector<GrainState>> leaving(rank_count);
  std::map<GrainId, int> destination;
  for (std::size_t slot = 0; slot < grains.size(); ++slot) {
    if (owners[slot] == ranks_.rank()) continue;
    leaving[static_cast<std::size_t>(owners[slot])].push_back(grains.state(slot));
    destination[grains.id[slot]] = owners[slot];
  }
  std::vector<Bytes> outgoing(rank_count);
  if (destination.empty()) return outgoing;
  const std::vector<PairSprings> all_pairs = grain_contacts.springs();
  const std::vector<WallSprings> all_walls = wall_contacts.springs();
  for (std::size_t rank = 0; rank < rank_count; ++rank) {
    if (leaving[rank].empty()) continue;
    const int to = static_cast<int>(rank);
    const auto goes = [&](GrainId id) {
      const auto found = destination.find(id);
      return found != destination.end() && found->second == to;
    };
    Bytes& bytes = outgoing[rank];
    pack<GrainState>(bytes, leaving[rank]);
    std::vector<PairSprings> pairs = all_pairs;
    std::erase_if(pairs, [&](const PairSprings& p) { return !goes(p.id_a) && !goes(p.id_b); });
    pack(bytes, static_cast<std::uint64_t>(pairs.size()));
    for (const PairSprings& pair : pairs) pack_springs(bytes, pair);
    std::vector<WallSprings> walls = all_walls;
    std::erase_if(walls, [&](const WallSprings& w) { return !goes(w.grain); });
    pack(bytes, static_cast<std::uint64_t>(walls.size()));
    for (const WallSprings& entry : walls) pack_springs(bytes, entry);
    counters_.migrated_grains += leaving[rank].size();
    counters_.migration_bytes += bytes.size();
  }
  return outgoing;
}

void Distribution::redistribute(Grains& grains, GrainContacts& grain_contacts,
                                WallContacts& wall_contacts, std::span<const ShapeView> shapes,
                                std::span<const double> costs, double reach,
                                const PeriodicCell* cell) {
  cell_.reset();
  if (cell != nullptr) cell_ = *cell;
  const std::vector<Vec3> places = places_in(cell, grains.position);
  decomposition_->update(places, costs, cell != nullptr ? reach * cell->stretch() : reach,
                         cell != nullptr ? cell->widths() : Vec3{});
  std::vector<int> owners(grains.size());
  bool some_leave = false;
  for (std::size_t slot = 0; slot < grains.size(); ++slot) {
    owners[slot] = decomposition_->owner_of(grains.id[slot], places[slot]);
    some_leave = some_leave || owners[slot] != ranks_.rank();
  }
  if (ranks_.any(some_leave)) {
    ++counters_.migrations;
    const Stock before = take_stock(ranks_, grains, shapes);
    const std::vector<Bytes> incoming =
        ranks_.all_to_all(pack_leaving(grains, owners, grain_contacts, wall_contacts));
    grains = without_leaving(grains, owners, ranks_.rank());
    for (const Bytes& bytes : incoming) {
      if (bytes.empty()) continue;
      Unpacker message{bytes};
      for (const GrainState& grain : message.take_all<GrainState>()) grains.push_back(grain);
      std::vector<PairSprings> pairs(static_cast<std::size_t>(message.take<std::uint64_t>()));
      for (PairSprings& pair : pairs) {
        pair.id_a = message.take<GrainId>();
        pair.id_b = message.take<GrainId>();
        pair.springs = message.take_all<NodeSpring>();
        for (const Bond& bond : message.take_all<Bond>()) pair.bond = bond;
      }
      grain_contacts.adopt(pairs);
      std::vector<WallSprings> walls(static_cast<std::size_t>(message.take<std::uint64_t>()));
      for (WallSprings& entry : walls) {
        entry.grain = message.take<GrainId>();
        entry.wall = message.take<WallId>();
        entry.springs = message.take_all<NodeSpring>();
      }
      wall_contacts.adopt(walls);
    }
    require(take_stock(ranks_, grains, shapes) == before, "mass or momentum was not kept");
  }
  auto count = static_cast<std::int64_t>(grains.size());
  ranks_.sum({&count, 1});
  require(count == static_cast<std::int64_t>(grain_count_),
          fmt::format("{} of {} grains are left", count, grain_count_));
}

void Distribution::list_ghosts(const Grains& grains) {
  std::vector<BorderGrain> owned;
  owned.reserve(grains.size());
  for (std::size_t slot = 0; slot < grains.size(); ++slot) {
    const Vec3& position = grains.position[slot];
    owned.push_back({grains.id[slot], grains.shape[slot], ghost_state(grains, slot),
                     cell_ ? cell_->place(position) : position});
  }
  ghosts_ = decomposition_->exchange_ghosts(std::move(owned));
}

void Distribution::start_update(const Grains& grains) {
  ghosts_->start([&](std::uint32_t slot) { return ghost_state(grains, slot); });
  ++counters_.updates;
  counters_.update_bytes += ghosts_->bytes_per_update();
  counters_.update_messages += ghosts_->messages_per_update();
}

void Distribution::finish_update() { ghosts_->finish(); }

std::vector<Pair> Distribution::find_pairs(std::span<const GrainFrame> frames,
                                           const AdaptiveSkin& skin, double gap,
                                           std::size_t owned) const {
  std::vector<GrainId> ids;
  std::vector<Vec3> positions;
  std::vector<double> radii;
  for (const GrainFrame& frame : frames) {
    ids.push_back(frame.id);
    positions.push_back(frame.position);
    radii.push_back(frame.shape->bounding_radius + skin.of(frame.velocity, frame.position) +
                    0.5 * gap);
  }
  constexpr double included = 0;  // the radii include the skin
  if (cell_) {
    return kind_ == DecompositionKind::replicated
               ? find_pairs_brute_force(ids, positions, radii, included, owned, &*cell_)
               : find_pairs_in_cell(ids, positions, radii, included, owned, *cell_);
  }
  switch (kind_) {
    case DecompositionKind::balanced:
      return reckon::find_pairs(ids, positions, radii, included, owned);
    case DecompositionKind::replicated:
      return find_pairs_brute_force(ids, positions, radii, included, owned);
    case DecompositionKind::grid:
    case DecompositionKind::bins:
      break;
  }
  const GridCut& cut = dynamic_cast<const GridDecomposition&>(*decomposition_).cut();
  if (ranks_.rank() >= cut.block_count()) return {};
  const BlockBins bins{cut, ranks_.rank(), positions, owned};
  return kind_ == DecompositionKind::grid ? bins.pairs_by_grain(ids, positions, radii, included)
                                          : bins.pairs_by_bin(ids, positions, radii, included);
}

}  // namespace reckon
