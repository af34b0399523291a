// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/labels.hpp"
#include "reckon/scan/segmentation.hpp"

namespace reckon {
namespace {

[[noreturn]] void fail(std::string problem, std::string reason, std::string fix) {
  throw Error{{.place = "split",
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = std::move(fix)}};
}

/// The watershed's pieces and the depths that they were made from.
struct Pieces {
  LabelsOnDisk labels;
  GrayOnDisk depth;
  std::uint32_t count{0};
  std::uint64_t solid{0};    // voxels
  std::uint64_t given{0};    // of them, to a piece
  std::uint64_t clashes{0};  // of them, to two
};

/// Whether a block's depth at a voxel is that of the volume: no void beyond a cut face is nearer.
bool is_certain(const Block& block, const Box& all, const VoxelDims& place, float depth) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto before = static_cast<float>(place[axis] - block.whole.low[axis] + 1);
    const auto behind = static_cast<float>(block.whole.end(axis) - place[axis]);
    if (block.whole.low[axis] > all.low[axis] && depth > before) return false;
    if (block.whole.end(axis) < all.end(axis) && depth > behind) return false;
  }
  return true;
}

/// By piece of a block: whether it is deepest in the block's core.
std::vector<bool> owned_pieces(const Block& block, const LabelVolume& labels,
                               const GrayVolume& depth) {
  std::vector<float> peak(1, 0);
  std::vector<bool> owned(1, false);
  std::size_t v = 0;
  for_each_voxel(block.whole, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const std::uint32_t label = labels.values[v];
    const float here = depth.values[v++];
    if (label >= peak.size()) {
      peak.resize(label + 1, 0);
      owned.resize(label + 1, false);
    }
    if (label == 0 || !(here > peak[label])) return;
    peak[label] = here;
    owned[label] = block.core.holds(i, j, k);
  });
  return owned;
}

/// Gives a block's own pieces to the volume.
void keep_owned(const Block& block, const LabelVolume& labels, const GrayVolume& depth,
                Pieces& pieces) {
  const std::vector<bool> owned = owned_pieces(block, labels, depth);
  std::vector<std::uint32_t> number(owned.size(), 0);
  for (std::size_t label = 0; label < owned.size(); ++label) {
    if (owned[label]) number[label] = ++pieces.count;
  }
  LabelVolume part = pieces.labels.read(block.whole);
  std::size_t v = 0;
  for_each_voxel(block.whole, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const std::size_t at = v++;
    const std::uint32_t own = number[labels.values[at]];
    if (own == 0) return;
    if (!is_certain(block, pieces.labels.box(), {i, j, k}, depth.values[at])) {
      fail("a grain is too large for the blocks",
           fmt::format("it reaches to voxel ({}, {}, {}), near the end of a block's overlap", i, j,
                       k),
           "Allow more --memory, or give a larger --overlap. If it is a wall, cut it off first.");
    }
    if (part.values[at] != 0) {
      ++pieces.clashes;
      return;
    }
    part.values[at] = own;
    ++pieces.given;
  });
  pieces.labels.write(part, block.whole);
}

Pieces find_pieces(const MaskOnDisk& mask, double least_rise, const std::vector<Block>& blocks,
                   const std::filesystem::path& folder) {
  Pieces pieces;
  pieces.labels = LabelsOnDisk{mask.dims(), mask.voxel(), folder};
  pieces.depth = GrayOnDisk{mask.dims(), mask.voxel(), folder};
  for (const Block& block : blocks) {
    const GrayVolume depth = depth_in_solid(mask.read(block.whole));
    pieces.depth.write(depth, block.core);
    for_each_voxel(block.core, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      if (depth.values[depth.index(i, j, k)] > 0) ++pieces.solid;
    });
    keep_owned(block, split_at_necks(depth, least_rise), depth, pieces);
  }
  return pieces;
}

/// A slab and the layer behind it.
Box with_next_layer(Box slab, const Box& all) {
  slab.dims[2] = std::min(slab.end(2) + 1, all.end(2)) - slab.low[2];
  return slab;
}

void refuse_blob(const LabelsOnDisk& labels, std::uint64_t solid, const Workspace& work) {
  for (const LabelledGrain& grain : measure_labels(labels, work)) {
    bool all_through = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      all_through &= grain.low[axis] == 0 && grain.high[axis] + 1 == labels.dims()[axis];
    }
    if (!all_through || 2 * grain.voxels <= solid) continue;
    fail("most of the solid is one blob that reaches all through the volume",
         fmt::format("it has {} of {} solid voxels", grain.voxels, solid),
         "If void is brighter than the grains, give --invert. Otherwise give a higher --threshold, "
         "a lower --neck or a lower --rise, and look at the preview.");
  }
}

}  // namespace

SplitGrains split_grains(const MaskOnDisk& mask, const SplitSettings& settings,
                         const GrayOnDisk* gray, const GrayLevels& levels, const Workspace& work) {
  const std::vector<Block> blocks = work.blocks(mask.dims(), work.grain_overlap());
  const Pieces pieces = find_pieces(mask, settings.least_rise, blocks, work.folder);
  // Pieces are renumbered, so that later stages do not depend on the blocks.
  Renumbering numbering;
  NeckJoiner joiner;
  for (const Box& slab : work.slabs(mask.dims())) {
    const Box part = with_next_layer(slab, mask.box());
    LabelVolume labels = pieces.labels.read(part);
    numbering.apply(labels);
    const GrayVolume gray_part = gray == nullptr ? GrayVolume{} : gray->read(part);
    joiner.add(labels, pieces.depth.read(part), gray == nullptr ? nullptr : &gray_part,
               slab.dims[2]);
  }
  if (numbering.count() == 0) {
    fail("no grains were found", "the mask holds no solid", "Check the threshold.");
  }
  const JoinedPieces joined = joiner.join({.wide = settings.neck,
                                           .largest_void = settings.neck_void,
                                           .void_gray = levels.void_gray,
                                           .solid_gray = levels.solid_gray});
  SplitGrains split;
  split.joined = joined.joined;
  split.blocks.blocks = blocks.size();
  split.blocks.overlap = blocks.size() > 1 ? work.grain_overlap() : 0;
  split.blocks.disputed = pieces.clashes + pieces.solid - pieces.given;
  split.labels = pieces.labels;
  Renumbering grains;
  for (const Box& slab : work.slabs(mask.dims())) {
    LabelVolume labels = pieces.labels.read(slab);
    numbering.apply(labels);
    for (std::uint32_t& label : labels.values) label = joined.label[label];
    grains.apply(labels);
    split.labels.write(labels, slab);
  }
  for (Waist waist : joined.waists) {
    waist.label = grains.number_of(joined.label[waist.label]);
    split.waists.push_back(waist);
  }
  refuse_blob(split.labels, pieces.solid, work);
  return split;
}

}  // namespace reckon
