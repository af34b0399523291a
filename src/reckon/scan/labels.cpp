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

struct Pass {
  std::uint32_t a;
  std::uint32_t b;
  float depth;
  double width;  // over the depth of the shallower piece
};

}  // namespace

std::uint32_t join_wide_necks(LabelVolume& labels, const GrayVolume& depth, double neck) {
  const std::uint32_t most =
      labels.values.empty() ? 0 : *std::max_element(labels.values.begin(), labels.values.end());
  std::vector<float> peak(most + 1, 0);
  for (std::size_t v = 0; v < labels.values.size(); ++v) {
    peak[labels.values[v]] = std::max(peak[labels.values[v]], depth.values[v]);
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, float> deepest;
  for_each_face(labels, [&](std::size_t v, std::size_t w) {
    const std::uint32_t a = std::min(labels.values[v], labels.values[w]);
    const std::uint32_t b = std::max(labels.values[v], labels.values[w]);
    if (a == b || a == 0) return;
    float& pass = deepest[{a, b}];
    pass = std::max(pass, std::min(depth.values[v], depth.values[w]));
  });
  std::vector<Pass> passes;
  passes.reserve(deepest.size());
  for (const auto& [pair, pass] : deepest) {
    passes.push_back({pair.first, pair.second, pass,
                      static_cast<double>(pass) / std::min(peak[pair.first], peak[pair.second])});
  }
  std::stable_sort(passes.begin(), passes.end(),
                   [](const Pass& p, const Pass& q) { return p.width > q.width; });
  Sets sets{peak.size()};
  std::uint32_t joined = 0;
  for (const Pass& pass : passes) {
    const std::uint32_t a = sets.find(pass.a);
    const std::uint32_t b = sets.find(pass.b);
    if (a == b || !(pass.depth > neck * std::min(peak[a], peak[b]))) continue;
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
