// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "reckon/core/exact_sum.hpp"
#include "reckon/math/portable.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/text/human.hpp"

namespace reckon {
namespace {

constexpr int face_layers = 2;           // that labels grow towards each other
constexpr double wide_face = 0.75;       // over the cross-section
constexpr double narrow_waist = 0.85;    // over the smaller piece's depth
constexpr double shape_of_ball = 1.209;  // cross-section over volume^(2/3)

/// Faces between two grown labels.
struct Facing {
  std::uint64_t faces{0};
  std::array<std::int64_t, 3> sum{};
};

std::string names_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 6;
  std::string text;
  for (std::size_t n = 0; n < std::min(most, names.size()); ++n) {
    text += (n > 0 ? ", " : "") + names[n];
  }
  return names.size() > most ? text + ", ..." : text;
}

}  // namespace

double cross_section_in_faces(std::uint64_t voxels) {
  constexpr double oblique = 1.5;
  const double root = portable::cbrt(static_cast<double>(voxels));
  return oblique * shape_of_ball * root * root;
}

std::vector<Doubt> doubtful_splits(const LabelsOnDisk& labels,
                                   const std::vector<LabelledGrain>& grains,
                                   const Workspace& work) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Facing> facings;
  for (const Box& slab : work.slabs(labels.dims())) {
    const Box wide = slab.widened(face_layers + 1, labels.box());
    const LabelVolume part = grown(labels.read(wide), face_layers);
    for_each_voxel(slab, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const std::uint32_t here = part.values[part.index(i, j, k)];
      if (here == 0) return;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        VoxelDims next{i, j, k};
        ++next[axis];
        if (!part.holds(next[0], next[1], next[2])) continue;
        const std::uint32_t other = part.values[part.index(next[0], next[1], next[2])];
        if (other == 0 || other == here) continue;
        Facing& facing = facings[std::minmax(here, other)];
        ++facing.faces;
        facing.sum[0] += i;
        facing.sum[1] += j;
        facing.sum[2] += k;
      }
    });
  }
  std::vector<Doubt> doubts;
  for (const auto& [pair, facing] : facings) {
    const std::uint64_t least =
        std::min(grains[pair.first - 1].voxels, grains[pair.second - 1].voxels);
    const double measure = static_cast<double>(facing.faces) / cross_section_in_faces(least);
    if (measure < wide_face) continue;
    Doubt doubt{Doubt::Kind::split, pair.first, pair.second, measure, {}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      doubt.voxel[axis] =
          static_cast<std::int32_t>(facing.sum[axis] / static_cast<std::int64_t>(facing.faces));
    }
    doubts.push_back(doubt);
  }
  std::stable_sort(doubts.begin(), doubts.end(),
                   [](const Doubt& a, const Doubt& b) { return a.measure > b.measure; });
  return doubts;
}

std::vector<Doubt> doubtful_joins(const std::vector<Waist>& waists) {
  std::map<std::uint32_t, Doubt> narrowest;
  for (const Waist& waist : waists) {
    if (waist.width >= narrow_waist) continue;
    const Doubt doubt{Doubt::Kind::join, waist.label, waist.label, waist.width, waist.voxel};
    const auto [place, is_new] = narrowest.emplace(waist.label, doubt);
    if (!is_new && waist.width < place->second.measure) place->second = doubt;
  }
  std::vector<Doubt> doubts;
  doubts.reserve(narrowest.size());
  for (const auto& [label, doubt] : narrowest) doubts.push_back(doubt);
  std::stable_sort(doubts.begin(), doubts.end(),
                   [](const Doubt& a, const Doubt& b) { return a.measure < b.measure; });
  return doubts;
}

std::vector<std::string> check_doubts(const std::vector<Doubt>& splits, std::size_t grains) {
  if (20 * splits.size() <= grains) return {};
  return {
      fmt::format("{} that may be two halves of one grain along a crack: they face each other over "
                  "a wide area",
                  counted(splits.size(), "pair"))};
}

std::vector<std::string> check_packing(const ScannedAssembly& assembly,
                                       const std::vector<LabelledGrain>& grains,
                                       const GrainChoice& choice, const GrayLevels& levels) {
  std::vector<std::string> remarks;
  const std::size_t count = assembly.quality.size();
  if (count == 0) return remarks;
  std::uint64_t kept_voxels = 0;
  std::uint64_t all_voxels = 0;
  for (const LabelledGrain& grain : grains) all_voxels += grain.voxels;
  for (const std::uint32_t label : choice.kept) kept_voxels += grains[label - 1].voxels;
  const double lost = 1 - static_cast<double>(kept_voxels) / static_cast<double>(all_voxels);
  if (lost > 0.5) {
    remarks.push_back(fmt::format(
        "{:.0f} % of the solid are in none of the grains: cut off by the border, or tiny. A "
        "container, a mask that is missing, or a wrong threshold do that",
        100 * lost));
  }
  std::vector<double> volumes;
  std::vector<std::string> off;
  std::vector<std::string> alone;
  std::vector<std::string> faint;
  std::size_t contacts = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const AvatarQuality& q = assembly.quality[n];
    const std::string& name = assembly.shapes[n].entry().name;
    volumes.push_back(q.volume);
    contacts += q.contacts;
    if (std::abs(q.volume / q.gray_volume - 1) > 0.02) off.push_back(name);
    if (q.neighbours == 0) alone.push_back(name);
    if (levels.share(q.solid_gray) < 0.75) faint.push_back(name);
  }
  if (!off.empty()) {
    remarks.push_back(fmt::format(
        "{} with a volume more than 2 % off that of the gray values ({}): the gray is not that of "
        "one solid in void, or the grain is in pieces",
        counted(off.size(), "avatar"), names_of(off)));
  }
  if (!faint.empty()) {
    remarks.push_back(fmt::format(
        "{} darker than three quarters of the step from void to solid ({}): another mineral, or "
        "shading. Other such grains may be missing",
        counted(faint.size(), "grain"), names_of(faint)));
  }
  if (count < 20) return remarks;
  if (10 * alone.size() > count) {
    remarks.push_back(fmt::format(
        "{} of {} without a neighbour within {} voxels ({}), which no packing has: neighbours are "
        "missing, or the threshold is too high",
        alone.size(), counted(count, "grain"), contact_reach, names_of(alone)));
  }
  const double mean = static_cast<double>(contacts) / static_cast<double>(count);
  if (mean < 2 || mean > 14) {
    remarks.push_back(fmt::format(
        "grains have {:.1f} contacts on average; packings have 4 to 10. Grains may be {}", mean,
        mean < 2 ? "missing, or the sample loose" : "in pieces"));
  }
  std::vector<double> sorted = volumes;
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[count / 2];
  std::vector<std::string> large;
  std::vector<std::string> small;
  for (std::size_t n = 0; n < count; ++n) {
    if (volumes[n] > 6 * median) large.push_back(assembly.shapes[n].entry().name);
    if (volumes[n] < median / 12) small.push_back(assembly.shapes[n].entry().name);
  }
  if (!large.empty()) {
    remarks.push_back(
        fmt::format("{} of more than six times the median volume ({}): several grains in one, or "
                    "a piece of a wall",
                    counted(large.size(), "grain"), names_of(large)));
  }
  if (small.size() * 20 > count) {
    remarks.push_back(
        fmt::format("{} of less than a twelfth of the median volume ({}): pieces of grains, "
                    "perhaps",
                    counted(small.size(), "grain"), names_of(small)));
  }
  return remarks;
}

std::vector<std::string> check_scan(const StoredScan& scan, const MaskOnDisk& mask, double spread) {
  constexpr float deep = 3;
  constexpr std::int32_t reach = 4;
  ExactSum sum;
  ExactSum squares;
  std::uint64_t count = 0;
  for (const Block& block : scan.work.blocks(scan.raw.dims(), reach)) {
    const GrayVolume gray = scan.raw.read(block.whole);
    const GrayVolume depth = depth_in_solid(mask.read(block.whole));
    for_each_voxel(block.core, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const std::size_t v = gray.index(i, j, k);
      if (depth.values[v] < deep) return;
      const double share = scan.levels.share(gray.values[v]);
      sum.add(share);
      squares.add(share * share);
      ++count;
    });
  }
  std::vector<std::string> remarks;
  if (count > 0) {
    const double mean = sum.value() / static_cast<double>(count);
    const double spread_of_gray =
        std::sqrt(std::max(0.0, squares.value() / static_cast<double>(count) - mean * mean));
    if (spread_of_gray > 0.09) {
      remarks.push_back(fmt::format(
          "gray varies by {:.0f} % of the step inside the grains (standard deviation): noise, "
          "rings, shading or minerals of other grays. Surfaces and contacts are less certain",
          100 * spread_of_gray));
    }
  }
  if (spread > 1.5) {
    remarks.push_back(fmt::format(
        "edges are blurred by {:.2f} voxels (standard deviation; 1 is usual): surfaces are "
        "smoother than the grains, narrow gaps close, and grains may be joined",
        spread));
  }
  return remarks;
}

}  // namespace reckon
