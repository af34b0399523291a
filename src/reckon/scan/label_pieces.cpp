// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/label_pieces.hpp"
#include "reckon/text/human.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace reckon {
namespace {

/// Numbers voxels, layer after layer, so that equal numbers are connected within the layers so far.
class PieceFinder {
 public:
  /// The next layers; `numbers` gets provisional numbers, which root() makes final.
  void add(const LabelVolume& given, LabelVolume& numbers) {
    const auto row = static_cast<std::size_t>(given.dims[0]);
    const std::size_t layer = row * static_cast<std::size_t>(given.dims[1]);
    std::size_t v = 0;
    for_each_voxel(given.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const std::size_t at = v++;
      const std::uint32_t label = given.values[at];
      if (label == 0) return;
      std::uint32_t own = 0;
      const auto meet = [&](std::uint32_t other_label, std::uint32_t number) {
        if (other_label != label) return;
        const std::uint32_t other = root(number);
        if (own != 0 && own != other) parent_[std::max(own, other)] = std::min(own, other);
        own = own == 0 ? other : std::min(own, other);
      };
      if (i > 0) meet(given.values[at - 1], numbers.values[at - 1]);
      if (j > 0) meet(given.values[at - row], numbers.values[at - row]);
      if (k > given.low[2]) {
        meet(given.values[at - layer], numbers.values[at - layer]);
      } else if (!last_given_.empty()) {
        meet(last_given_[at], last_numbers_[at]);
      }
      if (own == 0) {
        own = static_cast<std::uint32_t>(parent_.size());
        parent_.push_back(own);
      }
      numbers.values[at] = own;
    });
    const auto last = static_cast<std::ptrdiff_t>(layer);
    last_given_.assign(given.values.end() - last, given.values.end());
    last_numbers_.assign(numbers.values.end() - last, numbers.values.end());
  }

  std::uint32_t root(std::uint32_t number) {
    while (parent_[number] != number) {
      parent_[number] = parent_[parent_[number]];
      number = parent_[number];
    }
    return number;
  }

 private:
  std::vector<std::uint32_t> parent_{0};
  std::vector<std::uint32_t> last_given_;
  std::vector<std::uint32_t> last_numbers_;
};

}  // namespace

LabelPieces find_label_pieces(const LabelsOnDisk& given, const Workspace& work) {
  LabelPieces pieces;
  pieces.labels = LabelsOnDisk{given.dims(), given.voxel(), work.folder};
  PieceFinder finder;
  for (const Box& slab : work.slabs(given.dims())) {
    LabelVolume numbers{slab, given.voxel()};
    finder.add(given.read(slab), numbers);
    pieces.labels.write(numbers, slab);
  }
  Renumbering numbering;
  for (const Box& slab : work.slabs(given.dims())) {
    const LabelVolume labels = given.read(slab);
    LabelVolume numbers = pieces.labels.read(slab);
    for (std::uint32_t& number : numbers.values) number = finder.root(number);
    numbering.apply(numbers);
    pieces.given.resize(numbering.count(), 0);
    for (std::size_t v = 0; v < numbers.values.size(); ++v) {
      if (numbers.values[v] != 0) pieces.given[numbers.values[v] - 1] = labels.values[v];
    }
    pieces.labels.write(numbers, slab);
  }
  return pieces;
}

void name_by_label(std::vector<LabelledGrain>& grains, const LabelPieces& pieces) {
  std::vector<std::size_t> by_size(grains.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t{0});
  std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) {
    return grains[a].voxels > grains[b].voxels;
  });
  std::map<std::uint32_t, std::uint32_t> count;
  for (const std::size_t n : by_size) {
    grains[n].given = pieces.given[n];
    grains[n].piece = ++count[pieces.given[n]];
  }
}

std::vector<std::string> label_remarks(const std::vector<LabelledGrain>& grains,
                                       std::uint64_t fewest_voxels) {
  constexpr std::size_t most_listed = 12;
  std::map<std::uint32_t, std::vector<std::uint64_t>> sizes;
  for (const LabelledGrain& grain : grains) {
    if (grain.voxels >= fewest_voxels) sizes[grain.given].push_back(grain.voxels);
  }
  std::vector<std::string> remarks;
  std::vector<std::string> parts;
  for (auto& [label, voxels] : sizes) {
    if (voxels.size() < 2) continue;
    std::sort(voxels.rbegin(), voxels.rend());
    std::string text = fmt::format("label {}: {} of", label, counted(voxels.size(), "piece"));
    for (std::size_t n = 0; n < std::min<std::size_t>(voxels.size(), 4); ++n) {
      text += fmt::format("{} {}", n > 0 ? "," : "", voxels[n]);
    }
    parts.push_back(text + (voxels.size() > 4 ? ", ... voxels" : " voxels"));
  }
  if (!parts.empty()) {
    std::string text = fmt::format("{} of several pieces; each piece is a grain of its own ({}",
                                   counted(parts.size(), "label"), parts.front());
    for (std::size_t n = 1; n < std::min(parts.size(), most_listed); ++n) text += "; " + parts[n];
    remarks.push_back(text + (parts.size() > most_listed ? "; ...)" : ")"));
  }
  if (sizes.size() == 1 && sizes.begin()->second.size() > 1) {
    remarks.emplace_back(
        "the volume holds one label only, like a mask of the solid: grains that touch count as "
        "one. Leave out --labelled to split them");
  }
  return remarks;
}

}  // namespace reckon
