// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

/// Disjoint sets of labels; the lowest label represents its set.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  std::uint32_t find(std::uint32_t label) {
    while (parent_[label] != label) {
      parent_[label] = parent_[parent_[label]];
      label = parent_[label];
    }
    return label;
  }
  void join(std::uint32_t low, std::uint32_t high) { parent_[high] = low; }

 private:
  std::vector<std::uint32_t> parent_;
};

/// A face between two pieces.
struct Pass {
  std::uint32_t a;
  std::uint32_t b;
  float depth;
  double width;   // over the depth of the shallower piece
  bool is_solid;  // from the gray values
  VoxelDims place;
};

// Shallower voxels are darkened by the blur of the surface.
constexpr float gray_depth = 2;   // of the voxels that give the gray of a face [voxels]
constexpr float solid_depth = 3;  // of the voxels that give the solid of a piece
constexpr std::uint64_t fewest_in_neck = 4;
constexpr std::uint64_t fewest_solid = 30;

/// Adds the voxels of a part of the volume `all`.
void add_voxels(const LabelVolume& labels, const Box& all, std::vector<LabelledGrain>& grains) {
  std::size_t v = 0;
  for_each_voxel(labels.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const std::uint32_t label = labels.values[v++];
    if (label == 0) return;
    if (label > grains.size()) {
      grains.resize(label, {.low = {all.end(0), all.end(1), all.end(2)}});
    }
    LabelledGrain& grain = grains[label - 1];
    ++grain.voxels;
    const VoxelDims place{i, j, k};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      grain.low[axis] = std::min(grain.low[axis], place[axis]);
      grain.high[axis] = std::max(grain.high[axis], place[axis]);
      grain.on_border |= place[axis] == 0 || place[axis] + 1 == all.end(axis);
    }
  });
}

}  // namespace

void NeckJoiner::add(const LabelVolume& pieces, const GrayVolume& depth, const GrayVolume* gray,
                     std::int32_t layers) {
  for_each_face(pieces, layers, [&](std::size_t v, std::size_t w) {
    const std::uint32_t a = std::min(pieces.values[v], pieces.values[w]);
    const std::uint32_t b = std::max(pieces.values[v], pieces.values[w]);
    if (a == b || a == 0) return;
    Face& face = faces_[{a, b}];
    const float here = std::min(depth.values[v], depth.values[w]);
    if (here > face.depth) {
      face.depth = here;
      const auto row = static_cast<std::size_t>(pieces.dims[0]);
      const std::size_t layer = row * static_cast<std::size_t>(pieces.dims[1]);
      face.place = {pieces.low[0] + static_cast<std::int32_t>(v % row),
                    pieces.low[1] + static_cast<std::int32_t>(v % layer / row),
                    pieces.low[2] + static_cast<std::int32_t>(v / layer)};
    }
    if (gray != nullptr && here >= gray_depth) {
      face.gray.add(0.5 * (gray->values[v] + gray->values[w]));
    }
  });
  const std::size_t end = pieces.index(pieces.low[0], pieces.low[1], pieces.low[2] + layers);
  for (std::size_t v = 0; v < end; ++v) {
    const std::uint32_t piece = pieces.values[v];
    if (piece >= pieces_.size()) pieces_.resize(piece + 1);
    pieces_[piece].peak = std::max(pieces_[piece].peak, depth.values[v]);
    if (gray != nullptr && depth.values[v] >= solid_depth) pieces_[piece].gray.add(gray->values[v]);
  }
}

JoinedPieces NeckJoiner::join(const NeckRules& rules) const {
  const auto solid_of = [&](std::uint32_t piece) {
    const Mean& gray = pieces_[piece].gray;
    return gray.count < fewest_solid ? rules.solid_gray : gray.value();
  };
  std::vector<Pass> passes;
  passes.reserve(faces_.size());
  for (const auto& [pair, face] : faces_) {
    const auto& [a, b] = pair;
    bool is_solid = false;
    const double brighter = std::max(solid_of(a), solid_of(b)) - rules.void_gray;
    if (std::abs(solid_of(a) - solid_of(b)) > rules.other_mineral * brighter) continue;
    if (face.gray.count >= fewest_in_neck) {
      const double solid = 0.5 * (solid_of(a) + solid_of(b));
      const double missing = (solid - face.gray.value()) / (solid - rules.void_gray);
      is_solid = missing < rules.largest_void;
    }
    const double width =
        static_cast<double>(face.depth) / std::min(pieces_[a].peak, pieces_[b].peak);
    passes.push_back({a, b, face.depth, width, is_solid, face.place});
  }
  std::stable_sort(passes.begin(), passes.end(),
                   [](const Pass& p, const Pass& q) { return p.width > q.width; });
  std::vector<float> peak(pieces_.size());
  for (std::size_t p = 0; p < peak.size(); ++p) peak[p] = pieces_[p].peak;
  Sets sets{pieces_.size()};
  JoinedPieces result;
  for (const Pass& pass : passes) {
    const std::uint32_t a = sets.find(pass.a);
    const std::uint32_t b = sets.find(pass.b);
    const double least = pass.is_solid ? std::min(rules.narrow, rules.wide) : rules.wide;
    if (a == b || !(pass.depth > least * std::min(peak[a], peak[b]))) continue;
    sets.join(std::min(a, b), std::max(a, b));
    peak[std::min(a, b)] = std::max(peak[a], peak[b]);
    ++result.joined;
    result.waists.push_back({pass.a, pass.width, pass.place});
  }
  result.label.resize(pieces_.size());
  for (std::uint32_t p = 0; p < result.label.size(); ++p) result.label[p] = sets.find(p);
  return result;
}

void Renumbering::apply(LabelVolume& labels) {
  for (std::uint32_t& label : labels.values) {
    if (label == 0) continue;
    if (label >= number_.size()) number_.resize(label + 1, 0);
    if (number_[label] == 0) number_[label] = ++count_;
    label = number_[label];
  }
}

std::string name_of(const LabelledGrain& grain, std::uint32_t label) {
  if (grain.given == 0) return fmt::format("grain_{}", label);
  if (grain.piece == 1) return fmt::format("grain_{}", grain.given);
  return fmt::format("grain_{}_{}", grain.given, grain.piece);
}

std::vector<LabelledGrain> measure_labels(const LabelsOnDisk& labels, const Workspace& work) {
  std::vector<LabelledGrain> grains;
  for (const Box& slab : work.slabs(labels.dims())) {
    add_voxels(labels.read(slab), labels.box(), grains);
  }
  return grains;
}

GrainChoice choose_grains(const std::vector<LabelledGrain>& grains, bool keep_border,
                          std::uint64_t fewest_voxels) {
  GrainChoice choice;
  for (std::size_t n = 0; n < grains.size(); ++n) {
    if (grains[n].voxels < fewest_voxels) {
      ++choice.tiny;
    } else if (grains[n].on_border && !keep_border) {
      ++choice.on_border;
    } else {
      choice.kept.push_back(static_cast<std::uint32_t>(n + 1));
    }
  }
  return choice;
}

LabelVolume grown(const LabelVolume& labels, int layers) {
  LabelVolume now = labels;
  now.low = {0, 0, 0};
  const std::size_t row = now.index(0, 1, 0);
  const std::size_t slab = now.index(0, 0, 1);
  for (int layer = 0; layer < layers; ++layer) {
    LabelVolume next = now;
    parallel_for(static_cast<std::size_t>(now.dims[2]), 1, [&](std::size_t k) {
      for (std::int32_t j = 0; j < now.dims[1]; ++j) {
        for (std::int32_t i = 0; i < now.dims[0]; ++i) {
          const std::size_t at = now.index(i, j, static_cast<std::int32_t>(k));
          if (now.values[at] != 0) continue;
          std::uint32_t best = 0;
          const auto consider = [&](bool inside, std::size_t neighbour) {
            if (!inside || now.values[neighbour] == 0) return;
            if (best == 0 || now.values[neighbour] < best) best = now.values[neighbour];
          };
          consider(i > 0, at - 1);
          consider(i + 1 < now.dims[0], at + 1);
          consider(j > 0, at - row);
          consider(j + 1 < now.dims[1], at + row);
          consider(k > 0, at - slab);
          consider(k + 1 < static_cast<std::size_t>(now.dims[2]), at + slab);
          next.values[at] = best;
        }
      }
    });
    now = std::move(next);
  }
  now.low = labels.low;
  return now;
}

}  // namespace reckon
