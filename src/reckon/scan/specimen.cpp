// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/specimen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/scan/container.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/label_pieces.hpp"
#include "reckon/scan/leveling.hpp"

namespace reckon {
namespace {

constexpr std::size_t bins = 512;
constexpr double edge_share = 0.75;        // of the voxels on the upright edges that are one gray
constexpr double least_outside = 0.005;    // of the volume
constexpr std::int32_t surface_reach = 6;  // where the void beside a grain is looked for [voxels]

/// The gray of most voxels on the four upright edges of a volume, if nearly all have it.
std::optional<float> gray_of_edges(const GrayOnDisk& raw, const Workspace& work) {
  std::map<float, std::uint64_t> counts;
  const auto& dims = raw.dims();
  for (const Box& slab : work.slabs(dims)) {
    const GrayVolume part = raw.read(slab);
    for (std::int32_t k = slab.low[2]; k < slab.end(2); ++k) {
      for (const std::int32_t j : {0, dims[1] - 1}) {
        for (const std::int32_t i : {0, dims[0] - 1}) ++counts[part.values[part.index(i, j, k)]];
      }
    }
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  const double edges = 4.0 * dims[2];
  if (static_cast<double>(most->second) < edge_share * edges) return std::nullopt;
  return most->first;
}

/// Voxels of one gray that are connected to the vertical edges of the volume: 1, all others 0.
MaskOnDisk connected_to_edges(const GrayOnDisk& raw, float gray, const Workspace& work) {
  LabelsOnDisk same{raw.dims(), raw.voxel(), work.folder};
  for (const Box& slab : work.slabs(raw.dims())) {
    const GrayVolume part = raw.read(slab);
    LabelVolume labels{part};
    for (std::size_t v = 0; v < part.values.size(); ++v) {
      labels.values[v] = part.values[v] == gray ? 1 : 0;
    }
    same.write(labels, slab);
  }
  const LabelPieces pieces = find_label_pieces(same, work);
  std::vector<bool> at_edge(pieces.given.size() + 1, false);
  const auto& dims = raw.dims();
  for (const Box& slab : work.slabs(dims)) {
    const LabelVolume labels = pieces.labels.read(slab);
    for (std::int32_t k = slab.low[2]; k < slab.end(2); ++k) {
      for (const std::int32_t j : {0, dims[1] - 1}) {
        for (const std::int32_t i : {0, dims[0] - 1}) {
          at_edge[labels.values[labels.index(i, j, k)]] = true;
        }
      }
    }
  }
  at_edge[0] = false;
  MaskOnDisk outside{raw.dims(), raw.voxel(), work.folder};
  for (const Box& slab : work.slabs(dims)) {
    const LabelVolume labels = pieces.labels.read(slab);
    MaskVolume mask{labels};
    for (std::size_t v = 0; v < labels.values.size(); ++v) {
      mask.values[v] = at_edge[labels.values[v]] ? 1 : 0;
    }
    outside.write(mask, slab);
  }
  return outside;
}

std::uint64_t count_of(const MaskOnDisk& mask, const Workspace& work) {
  std::uint64_t count = 0;
  for (const Box& slab : work.slabs(mask.dims())) {
    for (const std::uint8_t voxel : mask.read(slab).values) count += voxel;
  }
  return count;
}

MaskOnDisk complement(const MaskOnDisk& mask, const Workspace& work) {
  MaskOnDisk result{mask.dims(), mask.voxel(), work.folder};
  for (const Box& slab : work.slabs(mask.dims())) {
    MaskVolume part = mask.read(slab);
    for (std::uint8_t& voxel : part.values) voxel = voxel == 0 ? 1 : 0;
    result.write(part, slab);
  }
  return result;
}

/// The share of the grains' surfaces, met along x, that have a voxel from outside before them. The
/// void of a scan without noise is constant too, but surrounds each grain.
double surfaces_at_outside(const GrayOnDisk& raw, const MaskOnDisk& outside, double threshold,
                           const Workspace& work) {
  std::uint64_t surfaces = 0;
  std::uint64_t at_outside = 0;
  for (const Box& slab : work.slabs(raw.dims())) {
    const GrayVolume gray = raw.read(slab);
    const MaskVolume mask = outside.read(slab);
    const std::int32_t nx = gray.dims[0];
    for_each_voxel(slab, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const std::size_t at = gray.index(i, j, k);
      if (mask.values[at] != 0 || !(gray.values[at] > threshold)) return;
      for (const std::int32_t step : {-1, 1}) {
        if (i + step < 0 || i + step >= nx) continue;
        const auto next = [&](std::int32_t n) { return gray.index(i + n * step, j, k); };
        if (mask.values[next(1)] == 0 && gray.values[next(1)] > threshold) continue;
        ++surfaces;
        for (std::int32_t n = 1; n <= surface_reach && i + n * step >= 0 && i + n * step < nx;
             ++n) {
          if (mask.values[next(n)] == 0) continue;
          ++at_outside;
          break;
        }
      }
    });
  }
  return surfaces == 0 ? 0 : static_cast<double>(at_outside) / static_cast<double>(surfaces);
}

/// The given specimen.
MaskOnDisk given_inside(const GrayOnDisk& raw, const SpecimenSettings& settings,
                        const Workspace& work) {
  const auto reader = open_volume({settings.mask, raw.voxel(), {}});
  if (reader->outline.dims != raw.dims()) {
    const VoxelDims& mask = reader->outline.dims;
    throw Error{{.place = settings.mask.string(),
                 .problem = "the mask and the volume differ in size",
                 .reason = fmt::format("{} x {} x {} and {} x {} x {} voxels", mask[0], mask[1],
                                       mask[2], raw.dims()[0], raw.dims()[1], raw.dims()[2]),
                 .fix = "Give a mask of the same voxels."}};
  }
  MaskOnDisk inside{raw.dims(), raw.voxel(), work.folder};
  for (const Box& slab : work.slabs(raw.dims())) {
    const GrayVolume part = reader->read_layers(slab.low[2], slab.dims[2]);
    MaskVolume mask{slab, raw.voxel()};
    for (std::size_t v = 0; v < part.values.size(); ++v) mask.values[v] = part.values[v] > 0;
    inside.write(mask, slab);
  }
  return inside;
}

/// Without the voxels beside those that are left out: they may be mixed with them.
MaskOnDisk shrunk(const MaskOnDisk& inside, const Workspace& work) {
  MaskOnDisk result{inside.dims(), inside.voxel(), work.folder};
  for (const Box& slab : work.slabs(inside.dims())) {
    const MaskVolume part = inside.read(slab.widened(1, inside.box()));
    MaskVolume mask{slab, inside.voxel()};
    std::size_t v = 0;
    for_each_voxel(slab, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      std::uint8_t all = 1;
      for (std::int32_t c = k - 1; c <= k + 1; ++c) {
        for (std::int32_t b = j - 1; b <= j + 1; ++b) {
          for (std::int32_t a = i - 1; a <= i + 1; ++a) {
            if (part.holds(a, b, c) && part.values[part.index(a, b, c)] == 0) all = 0;
          }
        }
      }
      mask.values[v++] = all;
    });
    result.write(mask, slab);
  }
  return result;
}

/// Whether voxels beside those of a constant gray are mixed with it, as after resampling: their
/// median then lies off the void's.
bool is_mixed(const GrayOnDisk& raw, const MaskOnDisk& inside, float outside_gray,
              const RoughLevels& levels, const Workspace& work) {
  std::vector<float> beside;
  for (const Box& slab : work.slabs(raw.dims())) {
    const MaskVolume mask = inside.read(slab);
    const GrayVolume gray = raw.read(slab);
    for_each_face(mask, slab.dims[2], [&](std::size_t v, std::size_t w) {
      if (w >= mask.values.size() || mask.values[v] == mask.values[w]) return;
      beside.push_back(gray.values[mask.values[v] != 0 ? v : w]);
    });
  }
  if (beside.empty()) return false;
  const auto middle = beside.begin() + static_cast<std::ptrdiff_t>(beside.size() / 2);
  std::nth_element(beside.begin(), middle, beside.end());
  constexpr double noticeable = 0.08;
  return std::abs(*middle - levels.void_gray) >
         noticeable * std::abs(outside_gray - levels.void_gray);
}

/// Voxels outside get the gray of void.
GrayOnDisk with_void_outside(const GrayOnDisk& gray, const MaskOnDisk& inside, double void_gray,
                             const Workspace& work) {
  GrayOnDisk result{gray.dims(), gray.voxel(), work.folder};
  for (const Box& slab : work.slabs(gray.dims())) {
    GrayVolume part = gray.read(slab);
    const MaskVolume mask = inside.read(slab);
    for (std::size_t v = 0; v < part.values.size(); ++v) {
      if (mask.values[v] == 0) part.values[v] = static_cast<float>(void_gray);
    }
    result.write(part, slab);
  }
  return result;
}

double median_bin(const std::vector<std::uint64_t>& counts, std::size_t first, std::size_t end) {
  std::uint64_t total = 0;
  for (std::size_t b = first; b < end; ++b) total += counts[b];
  std::uint64_t below = 0;
  for (std::size_t b = first; b < end; ++b) {
    if (2 * (below + counts[b]) >= total && counts[b] > 0) {
      const double part = (0.5 * static_cast<double>(total) - static_cast<double>(below)) /
                          static_cast<double>(counts[b]);
      return static_cast<double>(b) + part;
    }
    below += counts[b];
  }
  return 0.5 * static_cast<double>(first + end);
}

/// Where a class's counts are densest, smoothed over a few percent of the step: edges, which lie
/// between both classes, do not shift this as they do the median.
double densest(const std::vector<std::uint64_t>& counts, std::size_t first, std::size_t end,
               double smoothing) {
  const auto reach = static_cast<std::ptrdiff_t>(3 * smoothing) + 1;
  double best = 0;
  auto place = static_cast<double>(first);
  for (std::size_t b = first; b < end; ++b) {
    double height = 0;
    for (std::ptrdiff_t n = -reach; n <= reach; ++n) {
      const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(b) + n;
      if (from < 0 || from >= static_cast<std::ptrdiff_t>(counts.size())) continue;
      const auto off = static_cast<double>(n) / smoothing;
      height +=
          static_cast<double>(counts[static_cast<std::size_t>(from)]) * std::exp(-0.5 * off * off);
    }
    if (height <= best) continue;
    best = height;
    place = static_cast<double>(b) + 0.5;
  }
  return place;
}

}  // namespace

RoughLevels rough_levels(const std::vector<std::uint64_t>& counts, double low, double high) {
  const double width = (high - low) / static_cast<double>(counts.size());
  RoughLevels levels;
  levels.threshold = otsu_threshold(counts, low, high);
  const auto middle = static_cast<std::size_t>(
      std::clamp((levels.threshold - low) / width, 1.0, static_cast<double>(counts.size()) - 1));
  levels.void_gray = low + width * median_bin(counts, 0, middle);
  levels.solid_gray = low + width * median_bin(counts, middle, counts.size());
  return levels;
}

RoughLevels rough_levels(const GrayOnDisk& gray, const MaskOnDisk& inside, const Workspace& work) {
  // Equal bins between the least and the largest would starve when one voxel is very bright; the
  // outermost thousandth is put into the end bins by a first, coarse look.
  float least = std::numeric_limits<float>::infinity();
  float most = -least;
  const auto visit = [&](auto&& take) {
    for (const Box& slab : work.slabs(gray.dims())) {
      const GrayVolume part = gray.read(slab);
      const MaskVolume mask = inside.empty() ? MaskVolume{part, 1} : inside.read(slab);
      for (std::size_t v = 0; v < part.values.size(); ++v) {
        if (mask.values[v] != 0) take(part.values[v]);
      }
    }
  };
  visit([&](float value) {
    least = std::min(least, value);
    most = std::max(most, value);
  });
  double low = least;
  double high = most;
  std::vector<std::uint64_t> counts(bins, 0);
  for (int round = 0; round < 2 && high > low; ++round) {
    std::fill(counts.begin(), counts.end(), 0);
    std::uint64_t total = 0;
    visit([&](float value) {
      const double place = (value - low) / (high - low) * static_cast<double>(bins);
      ++counts[static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(bins) - 1))];
      ++total;
    });
    if (round > 0) break;
    const std::uint64_t tail = total / 1000;
    std::size_t first = 0;
    for (std::uint64_t sum = 0; first + 1 < bins && (sum += counts[first]) <= tail;) ++first;
    std::size_t end = bins;
    for (std::uint64_t sum = 0; end > first + 1 && (sum += counts[end - 1]) <= tail;) --end;
    const double width = (high - low) / static_cast<double>(bins);
    high = low + width * static_cast<double>(end);
    low += width * static_cast<double>(first);
  }
  if (!(high > low)) {
    throw Error{{.place = "threshold",
                 .problem = "the volume has one gray value only",
                 .reason = "nearly all voxels are equal",
                 .fix = "Is this the right file and data set?"}};
  }
  RoughLevels levels = rough_levels(counts, low, high);
  const double width = (high - low) / static_cast<double>(bins);
  const auto middle = static_cast<std::size_t>(
      std::clamp((levels.threshold - low) / width, 1.0, static_cast<double>(bins) - 1));
  constexpr double smoothing = 0.02;
  const double over = std::max(1.0, smoothing * levels.step() / width);
  levels.void_gray = low + width * densest(counts, 0, middle, over);
  levels.solid_gray = low + width * densest(counts, middle, bins, over);
  return levels;
}

MaskOnDisk find_inside(const GrayOnDisk& raw, const SpecimenSettings& settings,
                       const Workspace& work, std::vector<std::string>& remarks) {
  const auto voxels = static_cast<double>(raw.box().voxels());
  if (!settings.mask.empty()) {
    MaskOnDisk inside = given_inside(raw, settings, work);
    const std::uint64_t count = count_of(inside, work);
    if (count == 0) {
      throw Error{{.place = settings.mask.string(),
                   .problem = "the mask leaves nothing of the volume",
                   .reason = "none of its voxels is above 0",
                   .fix = "Voxels of the specimen have a value above 0."}};
    }
    remarks.push_back(fmt::format("{:.1f} % of the volume lie outside the mask and are left out",
                                  100 * (1 - static_cast<double>(count) / voxels)));
    return inside;
  }
  const auto gray = gray_of_edges(raw, work);
  if (!gray) return {};
  const MaskOnDisk outside = connected_to_edges(raw, *gray, work);
  const auto share = static_cast<double>(count_of(outside, work)) / voxels;
  if (share < least_outside || share > 1 - least_outside) return {};
  MaskOnDisk inside = complement(outside, work);
  const RoughLevels levels = rough_levels(raw, inside, work);
  // A constant void is no fault, and one that surrounds each grain is no outside.
  constexpr double same_gray = 0.03;
  if (std::abs(*gray - levels.void_gray) < same_gray * levels.step()) return {};
  if (surfaces_at_outside(raw, outside, levels.threshold, work) > 0.5) return {};
  remarks.push_back(
      fmt::format("{:.1f} % of the volume have the constant gray {:.6g} and lie outside the "
                  "reconstruction: left out. Void is about {:.6g}",
                  100 * share, *gray, levels.void_gray));
  if (is_mixed(raw, inside, *gray, levels, work)) inside = shrunk(inside, work);
  return inside;
}

Specimen find_specimen(const GrayOnDisk& raw, const SpecimenSettings& settings,
                       const Workspace& work) {
  Specimen specimen;
  specimen.gray = raw;
  specimen.inside = find_inside(raw, settings, work, specimen.remarks);
  if (!specimen.inside.empty()) {
    specimen.outer = specimen.inside;
    const RoughLevels levels = rough_levels(raw, specimen.inside, work);
    specimen.gray = with_void_outside(raw, specimen.inside, levels.void_gray, work);
  }
  if (!settings.keep_container) remove_container(specimen, work);
  if (!settings.keep_shading) level_gray(specimen, work);
  return specimen;
}

}  // namespace reckon
