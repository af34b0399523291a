// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/segmentation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/labels.hpp"

namespace reckon {
namespace {

constexpr float away = 2.5F;  // from the surface, where blur no longer reaches [voxels]
constexpr std::uint64_t fewest_for_level = 100;

[[noreturn]] void fail(const char* stage, std::string problem, std::string reason,
                       std::string fix) {
  throw Error{{.place = stage,
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = std::move(fix)}};
}

MaskVolume above(const GrayVolume& gray, double threshold) {
  MaskVolume mask{gray};
  for (std::size_t v = 0; v < gray.values.size(); ++v) mask.values[v] = gray.values[v] > threshold;
  return mask;
}

/// The mean gray of voxels deep inside a phase, or of all of it where there are too few of those.
double mean_inside(const GrayVolume& gray, const MaskVolume& phase) {
  const GrayVolume depth = depth_in_solid(phase);
  for (const float least : {away, 1.0F}) {
    double sum = 0;
    std::uint64_t count = 0;
    for (std::size_t v = 0; v < gray.values.size(); ++v) {
      if (phase.values[v] == 0 || depth.values[v] < least) continue;
      sum += gray.values[v];
      ++count;
    }
    if (count >= fewest_for_level || (least == 1.0F && count > 0)) {
      return sum / static_cast<double>(count);
    }
  }
  return 0;
}

void require_both(const MaskVolume& mask, double threshold) {
  const auto solid = static_cast<std::size_t>(
      std::count_if(mask.values.begin(), mask.values.end(), [](auto m) { return m != 0; }));
  if (solid > 0 && solid < mask.values.size()) return;
  fail("threshold", solid == 0 ? "no grains were found" : "there is no void between the grains",
       fmt::format("{} voxels are brighter than {:.6g}", solid == 0 ? "no" : "all", threshold),
       "Give a --threshold between the gray values of void and solid.");
}

}  // namespace

GrayVolume denoised(const GrayVolume& gray, const DenoiseSettings& settings) {
  switch (settings.method) {
    case Denoising::none:
      return gray;
    case Denoising::median:
      return median_filtered(gray);
    case Denoising::curvature:
      return curvature_diffused(gray, settings.iterations, settings.conductance);
  }
  return gray;
}

GrayLevels levels_of(const GrayVolume& gray, const MaskVolume& mask, double threshold) {
  MaskVolume voids{mask};
  for (std::size_t v = 0; v < mask.values.size(); ++v) voids.values[v] = mask.values[v] == 0;
  return {threshold, mean_inside(gray, voids), mean_inside(gray, mask)};
}

SolidMask find_solid(const GrayVolume& gray, const MaskSettings& settings) {
  SolidMask solid;
  const double first = settings.threshold ? *settings.threshold : otsu_threshold(gray);
  solid.mask = above(gray, first);
  require_both(solid.mask, first);
  solid.levels = levels_of(gray, solid.mask, first);
  if (!settings.threshold) {
    const double middle = 0.5 * (solid.levels.void_gray + solid.levels.solid_gray);
    solid.levels.threshold = middle;
    solid.mask = above(gray, middle);
    require_both(solid.mask, middle);
  }
  if (settings.fill) solid.mask = holes_filled(solid.mask);
  if (settings.open_radius > 0) solid.mask = opened(solid.mask, settings.open_radius);
  require_both(solid.mask, solid.levels.threshold);
  return solid;
}

SplitGrains split_grains(const MaskVolume& mask, const SplitSettings& settings,
                         const GrayVolume* gray, const GrayLevels& levels) {
  const GrayVolume depth = depth_in_solid(mask);
  SplitGrains split;
  split.labels = split_at_necks(depth, settings.least_rise);
  split.joined = join_wide_necks(split.labels, depth,
                                 {.wide = settings.neck,
                                  .largest_void = settings.neck_void,
                                  .gray = gray,
                                  .void_gray = levels.void_gray,
                                  .solid_gray = levels.solid_gray});
  const std::uint32_t count = renumber(split.labels);
  if (count == 0) {
    fail("split", "no grains were found", "the mask holds no solid", "Check the threshold.");
  }
  const auto grains = measure_labels(split.labels);
  const auto all_through = [&](const LabelledGrain& grain) {
    int axes = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      axes += grain.low[axis] == 0 && grain.high[axis] + 1 == mask.dims[axis] ? 1 : 0;
    }
    return axes == 3;
  };
  const auto solid = static_cast<std::uint64_t>(
      std::count_if(mask.values.begin(), mask.values.end(), [](auto m) { return m != 0; }));
  for (const LabelledGrain& grain : grains) {
    if (all_through(grain) && 2 * grain.voxels > solid) {
      fail("split", "most of the solid is one blob that reaches all through the volume",
           fmt::format("it has {} of {} solid voxels", grain.voxels, solid),
           "Give a higher --threshold, a lower --neck or a lower --rise, and look at the preview.");
    }
  }
  return split;
}

}  // namespace reckon
