// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/labels.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

/// Disjoint sets of labels; the lowest label stands for its set.
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
  bool is_solid;  // as the gray values tell
};

/// A mean in the making.
struct Mean {
  double sum{0};
  std::uint64_t count{0};

  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] double value() const { return sum / static_cast<double>(count); }
};

struct Face {
  float depth{0};  // at its deepest
  Mean gray;       // well inside the solid
};

// What lies less deep is darkened by the surface's own blur.
constexpr float gray_depth = 2;   // of the voxels of a face that tell its gray [voxels]
constexpr float solid_depth = 3;  // of the voxels that tell a piece's own solid
constexpr std::uint64_t fewest_in_neck = 4;
constexpr std::uint64_t fewest_solid = 30;

std::vector<Pass> list_passes(const LabelVolume& labels, const GrayVolume& depth,
                              const std::vector<float>& peak, const NeckRules& rules) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Face> faces;
  for_each_face(labels, [&](std::size_t v, std::size_t w) {
    const std::uint32_t a = std::min(labels.values[v], labels.values[w]);
    const std::uint32_t b = std::max(labels.values[v], labels.values[w]);
    if (a == b || a == 0) return;
    Face& face = faces[{a, b}];
    const float here = std::min(depth.values[v], depth.values[w]);
    face.depth = std::max(face.depth, here);
    if (rules.gray != nullptr && here >= gray_depth) {
      face.gray.add(0.5 * (rules.gray->values[v] + rules.gray->values[w]));
    }
  });
  std::vector<Mean> solid(peak.size());
  for (std::size_t v = 0; rules.gray != nullptr && v < labels.values.size(); ++v) {
    if (depth.values[v] >= solid_depth) solid[labels.values[v]].add(rules.gray->values[v]);
  }
  const auto solid_of = [&](std::uint32_t piece) {
    return solid[piece].count < fewest_solid ? rules.solid_gray : solid[piece].value();
  };
  std::vector<Pass> passes;
  passes.reserve(faces.size());
  for (const auto& [pair, face] : faces) {
    const auto& [a, b] = pair;
    bool is_solid = false;
    if (face.gray.count >= fewest_in_neck) {
      const double pieces = 0.5 * (solid_of(a) + solid_of(b));
      const double missing = (pieces - face.gray.value()) / (pieces - rules.void_gray);
      is_solid = missing < rules.largest_void;
    }
    const double width = static_cast<double>(face.depth) / std::min(peak[a], peak[b]);
    passes.push_back({a, b, face.depth, width, is_solid});
  }
  std::stable_sort(passes.begin(), passes.end(),
                   [](const Pass& p, const Pass& q) { return p.width > q.width; });
  return passes;
}

}  // namespace

std::uint32_t join_wide_necks(LabelVolume& labels, const GrayVolume& depth,
                              const NeckRules& rules) {
  const std::uint32_t most =
      labels.values.empty() ? 0 : *std::max_element(labels.values.begin(), labels.values.end());
  std::vector<float> peak(most + 1, 0);
  for (std::size_t v = 0; v < labels.values.size(); ++v) {
    peak[labels.values[v]] = std::max(peak[labels.values[v]], depth.values[v]);
  }
  Sets sets{peak.size()};
  std::uint32_t joined = 0;
  for (const Pass& pass : list_passes(labels, depth, peak, rules)) {
    const std::uint32_t a = sets.find(pass.a);
    const std::uint32_t b = sets.find(pass.b);
    const double least = pass.is_solid ? std::min(rules.narrow, rules.wide) : rules.wide;
    if (a == b || !(pass.depth > least * std::min(peak[a], peak[b]))) continue;
    sets.join(std::min(a, b), std::max(a, b));
    peak[std::min(a, b)] = std::max(peak[a], peak[b]);
    ++joined;
  }
  for (std::uint32_t& label : labels.values) label = sets.find(label);
  return joined;
}

std::uint32_t renumber(LabelVolume& labels) {
  const std::uint32_t most =
      labels.values.empty() ? 0 : *std::max_element(labels.values.begin(), labels.values.end());
  std::vector<std::uint32_t> number(most + 1, 0);
  std::uint32_t count = 0;
  for (std::uint32_t& label : labels.values) {
    if (label == 0) continue;
    if (number[label] == 0) number[label] = ++count;
    label = number[label];
  }
  return count;
}

std::vector<LabelledGrain> measure_labels(const LabelVolume& labels) {
  const std::uint32_t most =
      labels.values.empty() ? 0 : *std::max_element(labels.values.begin(), labels.values.end());
  std::vector<LabelledGrain> grains(most);
  for (LabelledGrain& grain : grains) grain.low = labels.dims;
  std::size_t v = 0;
  for (std::int32_t k = 0; k < labels.dims[2]; ++k) {
    for (std::int32_t j = 0; j < labels.dims[1]; ++j) {
      for (std::int32_t i = 0; i < labels.dims[0]; ++i, ++v) {
        if (labels.values[v] == 0) continue;
        LabelledGrain& grain = grains[labels.values[v] - 1];
        ++grain.voxels;
        const std::array<std::int32_t, 3> place{i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          grain.low[axis] = std::min(grain.low[axis], place[axis]);
          grain.high[axis] = std::max(grain.high[axis], place[axis]);
          grain.on_border |= place[axis] == 0 || place[axis] + 1 == labels.dims[axis];
        }
      }
    }
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
  return now;
}

}  // namespace reckon
