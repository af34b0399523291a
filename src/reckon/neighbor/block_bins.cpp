// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/neighbor/block_bins.hpp"

namespace reckon {
namespace {

/// 13 of the 26 neighbours: the nine above and four at the same level (paper, Fig. 3).
constexpr int half_stencil[13][3] = {{1, 0, 0},  {-1, 1, 0}, {0, 1, 0},  {1, 1, 0}, {-1, -1, 1},
                                     {0, -1, 1}, {1, -1, 1}, {-1, 0, 1}, {0, 0, 1}, {1, 0, 1},
                                     {-1, 1, 1}, {0, 1, 1},  {1, 1, 1}};

}  // namespace

BlockBins::BlockBins(const GridCut& cut, int block, std::span<const Vec3> positions,
                     std::size_t owned) {
  const std::array<int, 3> place = cut.block_place(block);
  std::array<int, 3> first{};  // the block's first bin in the whole domain's numbers
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    first[a] = cut.first_bin(axis, place[a]);
    size_[a] = cut.first_bin(axis, place[a] + 1) - first[a] + 2;
  }
  bins_.assign(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                   static_cast<std::size_t>(size_[2]),
               nothing);
  bin_list_.resize(positions.size());
  grain_list_.assign(positions.size(), nothing);
  belongs_to_rank_.assign(positions.size(), Residence::ghost);
  for (std::uint32_t grain = 0; grain < positions.size(); ++grain) {
    if (grain < owned) belongs_to_rank_[grain] = Residence::inside;
    std::array<int, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      at[a] = cut.bin_of(axis, positions[grain][axis]) - first[a] + 1;
    }
    const std::uint32_t bin = bin_at(at[0], at[1], at[2]);
    bin_list_[grain] = bin;
    grain_list_[grain] = bins_[bin];
    bins_[bin] = grain;
  }
}

std::uint32_t BlockBins::bin_at(int x, int y, int z) const {
  return static_cast<std::uint32_t>((z * size_[1] + y) * size_[0] + x);
}

template <class Visit>
void BlockBins::visit_half_neighbors(std::uint32_t grain, Visit&& visit) const {
  for (std::uint32_t other = grain_list_[grain]; other != nothing; other = grain_list_[other]) {
    visit(other);
  }
  const auto bin = static_cast<int>(bin_list_[grain]);
  const int x = bin % size_[0];
  const int y = bin / size_[0] % size_[1];
  const int z = bin / (size_[0] * size_[1]);
  for (const auto& step : half_stencil) {
    const int nx = x + step[0];
    const int ny = y + step[1];
    const int nz = z + step[2];
    // Only a ghost, in the padding, can have a neighbour outside it; ghosts need no such partner.
    if (nx < 0 || ny < 0 || nx >= size_[0] || ny >= size_[1] || nz >= size_[2]) continue;
    for (std::uint32_t other = bins_[bin_at(nx, ny, nz)]; other != nothing;
         other = grain_list_[other]) {
      visit(other);
    }
  }
}

void BlockBins::add_pairs_of(std::uint32_t grain, std::span<const GrainId> ids,
                             std::span<const Vec3> positions, std::span<const double> radii,
                             double skin, std::vector<Pair>& pairs) const {
  visit_half_neighbors(grain, [&](std::uint32_t other) {
    if (belongs_to_rank_[grain] == Residence::ghost &&
        belongs_to_rank_[other] == Residence::ghost) {
      return;
    }
    add_if_near(pairs, ids, positions, radii, skin, grain, other);
  });
}

std::vector<Pair> BlockBins::pairs_by_grain(std::span<const GrainId> ids,
                                            std::span<const Vec3> positions,
                                            std::span<const double> radii, double skin) const {
  std::vector<Pair> pairs;
  for (std::uint32_t grain = 0; grain < positions.size(); ++grain) {
    add_pairs_of(grain, ids, positions, radii, skin, pairs);
  }
  sort_by_ids(pairs);
  return pairs;
}

std::vector<Pair> BlockBins::pairs_by_bin(std::span<const GrainId> ids,
                                          std::span<const Vec3> positions,
                                          std::span<const double> radii, double skin) const {
  std::vector<Pair> pairs;
  for (const std::uint32_t first : bins_) {
    for (std::uint32_t grain = first; grain != nothing; grain = grain_list_[grain]) {
      add_pairs_of(grain, ids, positions, radii, skin, pairs);
    }
  }
  sort_by_ids(pairs);
  return pairs;
}

}  // namespace reckon
