// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "reckon/scan/volume.hpp"

namespace reckon {

/// Volumes that exceed memory are worked on block by block. A volume that does not is one block.
///
///     |<----- whole ----->|          Each voxel lies in one core. What is worked out in a block
///     |   +-----------+   |          is right as far from the block's cut faces as voxels act on
///     |   |   core    |   |          each other; only the core of it is kept. `whole` ends with
///     |   +-----------+   |          the volume.
///
struct Block {
  Box core;
  Box whole;
};

/// How much may be held at once, and where the rest is kept. Results do not depend on it, as long
/// as grains are smaller than the overlap.
struct Workspace {
  std::filesystem::path folder;  ///< of scratch files
  std::uint64_t memory{0};       ///< for volumes [bytes]; 0: half of the machine's
  std::int32_t overlap{0};       ///< of blocks where grains are split [voxels]; 0: see below

  /// `memory` or its default.
  [[nodiscard]] std::uint64_t memory_limit() const;
  /// How many voxels a block may have.
  [[nodiscard]] std::uint64_t block_voxels() const;
  /// `overlap`, or a quarter of the edge of a cube of block_voxels().
  [[nodiscard]] std::int32_t grain_overlap() const;
  /// Blocks whose `whole` reaches `overlap` voxels beyond the core, cut across the longest edges
  /// first. Throws Error when the memory is too small for that.
  [[nodiscard]] std::vector<Block> blocks(const VoxelDims& dims, std::int32_t overlap) const;
  /// The volume in runs of whole layers, from the first to the last; at least one layer each.
  /// Throws Error when each needs `margin` layers more on either side and the memory is too small
  /// for that.
  [[nodiscard]] std::vector<Box> slabs(const VoxelDims& dims, std::int32_t margin = 0) const;
};

/// The machine's memory [bytes].
[[nodiscard]] std::uint64_t machine_memory();

}  // namespace reckon
