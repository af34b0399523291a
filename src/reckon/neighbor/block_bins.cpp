// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/neighbor/block_bins.hpp"

#include <bit>

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
    const int length = cut.first_bin(axis, place[a] + 1) - first[a] + 2;
    size_[a] = static_cast<std::uint64_t>(length);
  }
  const auto table_size = std::bit_ceil(2 * positions.size() + 2);
  shift_ = 64 - static_cast<int>(std::countr_zero(table_size));
  bins_.assign(table_size, nothing);
  bin_list_.resize(positions.size());
  grain_list_.assign(positions.size(), nothing);
  belongs_to_rank_.assign(positions.size(), Residence::ghost);
  for (std::uint32_t grain = 0; grain < positions.size(); ++grain) {
    if (grain < owned) belongs_to_rank_[grain] = Residence::inside;
    std::array<std::uint64_t, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const int inside = cut.bin_of(axis, positions[grain][axis]) - first[a] + 1;
      at[a] = static_cast<std::uint64_t>(inside);
    }
    const std::uint64_t bin = bin_at(at[0], at[1], at[2]);
    bin_list_[grain] = bin;
    std::uint32_t& head = bins_[slot_of(bin)];
    grain_list_[grain] = head;
    head = grain;
  }
}

std::uint64_t BlockBins::bin_at(std::uint64_t x, std::uint64_t y, std::uint64_t z) const {
  return (z * size_[1] + y) * size_[0] + x;
}

std::size_t BlockBins::slot_of(std::uint64_t bin) const {
  return static_cast<std::size_t>(bin * 0x9E3779B97F4A7C15U >> shift_);
}

template <class Visit>
void BlockBins::visit_bin(std::uint64_t bin, Visit&& visit) const {
  for (std::uint32_t other = bins_[slot_of(bin)]; other != nothing; other = grain_list_[other]) {
    if (bin_list_[other] == bin) visit(other);
  }
}

template <class Visit>
void BlockBins::visit_half_neighbors(std::uint32_t grain, Visit&& visit) const {
  const std::uint64_t bin = bin_list_[grain];
  for (std::uint32_t other = grain_list_[grain]; other != nothing; other = grain_list_[other]) {
    if (bin_list_[other] == bin) visit(other);
  }
  const std::array<std::uint64_t, 3> at{bin % size_[0], bin / size_[0] % size_[1],
                                        bin / (size_[0] * size_[1])};
  for (const auto& step : half_stencil) {
    std::array<std::uint64_t, 3> next{};
    bool is_bin = true;
    for (std::size_t a = 0; a < 3; ++a) {
      next[a] = at[a] + static_cast<std::uint64_t>(step[a]);  // below zero: beyond any size
      is_bin = is_bin && next[a] < size_[a];
    }
    // Only a ghost, in the padding, can have a neighbour outside it; ghosts need no such partner.
    if (is_bin) visit_bin(bin_at(next[0], next[1], next[2]), visit);
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
  // An empty box costs time, not memory, but how large it is must not decide how long that takes.
  constexpr std::uint64_t bins_per_grain = 4096;
  if (bin_count() / bins_per_grain > positions.size()) {
    return pairs_by_grain(ids, positions, radii, skin);
  }
  std::vector<Pair> pairs;
  for (std::uint64_t bin = 0; bin < bin_count(); ++bin) {
    visit_bin(
        bin, [&](std::uint32_t grain) { add_pairs_of(grain, ids, positions, radii, skin, pairs); });
  }
  sort_by_ids(pairs);
  return pairs;
}

}  // namespace reckon
