// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/segmentation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reckon/core/error.hpp"
#include "reckon/scan/gray_statistics.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/phases.hpp"

namespace reckon {
namespace {

constexpr std::int32_t filter_reach = 1;  // of one step of denoising [voxels]

MaskVolume above(const GrayVolume& gray, double threshold) {
  MaskVolume mask{gray};
  for (std::size_t v = 0; v < gray.values.size(); ++v) mask.values[v] = gray.values[v] > threshold;
  return mask;
}

/// A volume whose blocks are made from those of another.
template <class Filter>
GrayOnDisk filtered(const GrayOnDisk& gray, const Workspace& work, Filter&& filter) {
  GrayOnDisk result{gray.dims(), gray.voxel(), work.folder};
  for (const Block& block : work.blocks(gray.dims(), filter_reach)) {
    result.write(filter(gray.read(block.whole)), block.core);
  }
  return result;
}

}  // namespace

void require_both_phases(std::uint64_t solid, std::uint64_t voids, double threshold) {
  if (solid > 0 && voids > 0) return;
  throw Error{
      {.place = "threshold",
       .problem = solid == 0 ? "no grains were found" : "there is no void between the grains",
       .reason =
           fmt::format("{} voxels are brighter than {:.6g}", solid == 0 ? "no" : "all", threshold),
       .fix = "Give a --threshold between the gray values of void and solid."}};
}

GrayOnDisk denoised(const GrayOnDisk& gray, const DenoiseSettings& settings,
                    const Workspace& work) {
  if (settings.method == Denoising::median) return filtered(gray, work, median_filtered);
  GrayOnDisk now = gray;
  if (settings.method == Denoising::none) return now;
  for (std::uint32_t n = 0; n < settings.iterations; ++n) {
    const double gradient = mean_gradient(now, work);
    now = filtered(now, work, [&](const GrayVolume& part) {
      return curvature_diffused(part, gradient, settings.conductance);
    });
  }
  return now;
}

GrayLevels levels_of(const GrayOnDisk& gray, const MaskOnDisk& mask, double threshold,
                     const Workspace& work) {
  return phase_levels(
      gray, [&](const GrayVolume& part) { return mask.read(part.box()); }, threshold, work);
}

SolidMask find_solid(const GrayOnDisk& gray, const MaskSettings& settings, const Workspace& work,
                     const MaskOnDisk& inside) {
  GrayPhases phases;
  if (!settings.grays.empty()) {
    phases = given_phases(settings.grays);
  } else if (!settings.threshold && settings.phases != 1) {
    phases = find_phases(gray, inside, work);
  }
  const bool several = phases.solid.size() > 1;
  const bool has_faint = phases.faint().has_value();
  // Of several phases the most common one gives the levels.
  const double first = settings.threshold ? *settings.threshold
                       : has_faint        ? 0.5 * (phases.void_gray + phases.main)
                                          : otsu_threshold(gray, work);
  SolidMask solid;
  if (several) solid.phases = phases.solid;
  solid.levels = phase_levels(
      gray, [&](const GrayVolume& part) { return above(part, first); }, first, work);
  if (!settings.threshold) {
    // The faint phase lies among what is taken for void here.
    if (has_faint) solid.levels = {first, phases.void_gray, phases.main};
    solid.levels.threshold = 0.5 * (solid.levels.void_gray + solid.levels.solid_gray);
  }
  solid.mask = MaskOnDisk{gray.dims(), gray.voxel(), work.folder};
  const auto radius = static_cast<std::int32_t>(settings.open_radius);
  std::uint64_t count = 0;
  // Voids inside grains are not larger than grains.
  const std::int32_t overlap =
      2 * radius + (settings.fill ? work.grain_overlap() : 0) + (has_faint ? faint_reach : 0);
  for (const Block& block : work.blocks(gray.dims(), overlap)) {
    const GrayVolume part = gray.read(block.whole);
    MaskVolume mask = above(part, solid.levels.threshold);
    if (has_faint) {
      const MaskVolume more = faint_solid(part, phases);
      for (std::size_t v = 0; v < mask.values.size(); ++v) mask.values[v] |= more.values[v];
    }
    if (settings.fill) mask = holes_filled(mask);
    if (radius > 0) mask = opened(mask, settings.open_radius);
    solid.mask.write(mask, block.core);
    for_each_voxel(block.core, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      count += mask.values[mask.index(i, j, k)];
    });
  }
  require_both_phases(count, gray.box().voxels() - count, solid.levels.threshold);
  return solid;
}

}  // namespace reckon
