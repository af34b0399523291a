// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/blocks.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reckon/core/error.hpp"
#include "reckon/math/portable.hpp"

namespace reckon {
namespace {

// At most, in any stage; the watershed needs the most.
constexpr std::uint64_t bytes_per_voxel = 40;

std::int32_t core_edge(std::int32_t dim, std::int32_t parts) { return (dim + parts - 1) / parts; }

/// Voxels of the largest block with its overlap.
std::uint64_t largest_block(const VoxelDims& dims, const VoxelDims& parts, std::int32_t overlap) {
  std::uint64_t voxels = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t edge = core_edge(dims[axis], parts[axis]) + std::int64_t{2} * overlap;
    voxels *= static_cast<std::uint64_t>(std::min<std::int64_t>(edge, dims[axis]));
  }
  return voxels;
}

std::vector<Block> cut(const VoxelDims& dims, const VoxelDims& parts, std::int32_t overlap) {
  const Box all{dims};
  VoxelDims edge{};
  for (std::size_t axis = 0; axis < 3; ++axis) edge[axis] = core_edge(dims[axis], parts[axis]);
  std::vector<Block> blocks;
  for (std::int32_t z = 0; z < dims[2]; z += edge[2]) {
    for (std::int32_t y = 0; y < dims[1]; y += edge[1]) {
      for (std::int32_t x = 0; x < dims[0]; x += edge[0]) {
        const Box core{{x, y, z},
                       {std::min(edge[0], dims[0] - x), std::min(edge[1], dims[1] - y),
                        std::min(edge[2], dims[2] - z)}};
        blocks.push_back({core, core.widened(overlap, all)});
      }
    }
  }
  return blocks;
}

}  // namespace

std::uint64_t machine_memory() {
  return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
         static_cast<std::uint64_t>(::sysconf(_SC_PAGE_SIZE));
}

std::uint64_t Workspace::memory_limit() const {
  return memory == 0 ? machine_memory() / 2 : memory;
}

std::uint64_t Workspace::block_voxels() const { return memory_limit() / bytes_per_voxel; }

std::int32_t Workspace::grain_overlap() const {
  if (overlap > 0) return overlap;
  return static_cast<std::int32_t>(portable::cbrt(static_cast<double>(block_voxels())) / 4);
}

std::vector<Block> Workspace::blocks(const VoxelDims& dims, std::int32_t overlap_here) const {
  VoxelDims parts{1, 1, 1};
  while (largest_block(dims, parts, overlap_here) > block_voxels()) {
    std::size_t longest = 2;
    for (const std::size_t axis : {1U, 0U}) {
      if (core_edge(dims[axis], parts[axis]) > core_edge(dims[longest], parts[longest])) {
        longest = axis;
      }
    }
    if (parts[longest] >= dims[longest]) {
      throw Error{{.place = "--memory",
                   .problem = "the memory is too small for the volume's blocks",
                   .reason = fmt::format("blocks overlap by {} voxels and may have {}",
                                         overlap_here, block_voxels()),
                   .fix = "Allow more memory, or a smaller --overlap if grains are small."}};
    }
    ++parts[longest];
  }
  return cut(dims, parts, overlap_here);
}

std::vector<Box> Workspace::slabs(const VoxelDims& dims, std::int32_t margin) const {
  const std::uint64_t layer = Box{{dims[0], dims[1], 1}}.voxels();
  const auto count = static_cast<std::int64_t>(block_voxels() / layer);
  // The volume's ends need no margin, so one slab may hold all that fits.
  const std::int64_t most = count >= dims[2] ? dims[2] : count - 2 * std::int64_t{margin};
  if (most < 1 && margin > 0) {
    throw Error{
        {.place = "--memory",
         .problem = "the memory is too small for the volume's layers",
         .reason = fmt::format("{} layers at once need {} bytes, {} are allowed", 2 * margin + 1,
                               static_cast<std::uint64_t>(2 * margin + 1) * layer * bytes_per_voxel,
                               memory_limit()),
         .fix = "Allow more memory."}};
  }
  const auto layers = static_cast<std::int32_t>(std::max<std::int64_t>(most, 1));
  std::vector<Box> slabs;
  for (std::int32_t z = 0; z < dims[2]; z += layers) {
    slabs.push_back({{0, 0, z}, {dims[0], dims[1], std::min(layers, dims[2] - z)}});
  }
  return slabs;
}

}  // namespace reckon
