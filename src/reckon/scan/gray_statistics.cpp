// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/gray_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/core/exact_sum.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/scan/image_filters.hpp"

namespace reckon {
namespace {

constexpr std::size_t bins = 256;
constexpr std::uint64_t tail_parts = 1000;  // of which one is left out at either end
constexpr std::array away{2.5F, 1.0F};      // from the surface: beyond its blur, or at least inside
constexpr std::int32_t depth_reach = 3;     // of the voxels that decide whether another is `away`
constexpr std::uint64_t fewest_for_level = 100;

/// A float's bits, turned such that they sort as the numbers do.
std::uint32_t sortable(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits >> 31U) != 0 ? ~bits : bits | 0x80000000U;
}
float from_sortable(std::uint32_t bits) {
  return std::bit_cast<float>((bits >> 31U) != 0 ? bits & 0x7fffffffU : ~bits);
}

using HalfCounts = std::vector<std::uint64_t>;  // by 16 bits

/// Where the `rank`-th smallest lies; `rank` becomes its rank there.
std::uint32_t bin_of(const HalfCounts& counts, std::uint64_t& rank) {
  std::uint32_t bin = 0;
  while (rank >= counts[bin]) rank -= counts[bin++];
  return bin;
}

/// The values of these ranks in order of size, from 0: counted by the upper halves of their bits,
/// then by the lower ones.
std::array<float, 2> values_of_ranks(const GrayOnDisk& gray, std::array<std::uint64_t, 2> ranks,
                                     const Workspace& work) {
  constexpr std::size_t halves = 65536;
  HalfCounts upper(halves, 0);
  for (const Box& slab : work.slabs(gray.dims())) {
    for (const float value : gray.read(slab).values) ++upper[sortable(value) >> 16U];
  }
  std::array<std::uint32_t, 2> bin{};
  for (std::size_t r = 0; r < 2; ++r) bin[r] = bin_of(upper, ranks[r]);
  std::array<HalfCounts, 2> lower{HalfCounts(halves, 0), HalfCounts(halves, 0)};
  for (const Box& slab : work.slabs(gray.dims())) {
    for (const float value : gray.read(slab).values) {
      const std::uint32_t bits = sortable(value);
      for (std::size_t r = 0; r < 2; ++r) {
        if (bits >> 16U == bin[r]) ++lower[r][bits & 0xffffU];
      }
    }
  }
  std::array<float, 2> values{};
  for (std::size_t r = 0; r < 2; ++r) {
    values[r] = from_sortable(bin[r] << 16U | bin_of(lower[r], ranks[r]));
  }
  return values;
}

/// Gray values of one phase.
struct Phase {
  std::array<ExactSum, 2> sum;  // by `away`
  std::array<std::uint64_t, 2> count{};

  void add(const GrayVolume& gray, const MaskVolume& phase, const Box& core) {
    const GrayVolume depth = depth_in_solid(phase);
    for_each_voxel(core, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const std::size_t v = gray.index(i, j, k);
      for (std::size_t least = 0; phase.values[v] != 0 && least < away.size(); ++least) {
        if (depth.values[v] < away[least]) continue;
        sum[least].add(gray.values[v]);
        ++count[least];
      }
    });
  }
  [[nodiscard]] double mean() const {
    const std::size_t least = count[0] >= fewest_for_level ? 0 : 1;
    return sum[least].value() / static_cast<double>(count[least]);
  }
};

}  // namespace

double otsu_threshold(const GrayOnDisk& gray, const Workspace& work) {
  const std::uint64_t voxels = gray.box().voxels();
  const std::uint64_t tail = voxels / tail_parts;
  const auto [low, high] = values_of_ranks(gray, {tail, voxels - tail - 1}, work);
  if (!(high > low)) {
    throw Error{{.place = "threshold",
                 .problem = "the volume has one gray value only",
                 .reason = "nearly all voxels are equal",
                 .fix = "Is this the right file and data set?"}};
  }
  std::vector<std::uint64_t> counts(bins, 0);
  const float scale = static_cast<float>(bins) / (high - low);
  for (const Box& slab : work.slabs(gray.dims())) {
    for (const float value : gray.read(slab).values) {
      const float place = std::clamp((value - low) * scale, 0.0F, static_cast<float>(bins) - 1);
      ++counts[static_cast<std::size_t>(place)];
    }
  }
  return otsu_threshold(counts, low, high);
}

double mean_gradient(const GrayOnDisk& gray, const Workspace& work) {
  ExactSum squares;
  for (const Box& slab : work.slabs(gray.dims())) {
    const GrayVolume part = gray.read(slab.widened(1, gray.box()));
    std::vector<ExactSum> of_layer(static_cast<std::size_t>(slab.dims[2]));
    parallel_for(of_layer.size(), 1, [&](std::size_t layer) {
      Box voxels = slab;
      voxels.low[2] += static_cast<std::int32_t>(layer);
      voxels.dims[2] = 1;
      for_each_voxel(voxels, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
        double square = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          VoxelDims before{i, j, k};
          VoxelDims after{i, j, k};
          before[axis] = std::max(before[axis] - 1, 0);
          after[axis] = std::min(after[axis] + 1, gray.dims()[axis] - 1);
          const float difference = part.values[part.index(after[0], after[1], after[2])] -
                                   part.values[part.index(before[0], before[1], before[2])];
          square += 0.25 * difference * difference;
        }
        of_layer[layer].add(square);
      });
    });
    for (const ExactSum& sum : of_layer) squares.add(sum);
  }
  return std::sqrt(squares.value() / static_cast<double>(gray.box().voxels()));
}

GrayLevels phase_levels(const GrayOnDisk& gray,
                        const std::function<MaskVolume(const GrayVolume&)>& solid_of,
                        double threshold, const Workspace& work) {
  Phase solid;
  Phase voids;
  for (const Block& block : work.blocks(gray.dims(), depth_reach)) {
    const GrayVolume part = gray.read(block.whole);
    MaskVolume phase = solid_of(part);
    solid.add(part, phase, block.core);
    for (std::uint8_t& voxel : phase.values) voxel = voxel == 0 ? 1 : 0;
    voids.add(part, phase, block.core);
  }
  require_both_phases(solid.count[1], voids.count[1], threshold);
  return {threshold, voids.mean(), solid.mean()};
}

}  // namespace reckon
