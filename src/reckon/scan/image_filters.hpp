// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "reckon/scan/volume.hpp"

/// The image processing that the Insight Toolkit does for us: the component `ct`. In a build
/// without it each of these throws an Error that states how to get it. All use all threads; the
/// results do not depend on their number.
namespace reckon {

/// Whether the component was built in.
[[nodiscard]] bool has_ct_component();
/// Throws Error when it was not.
void require_ct_component();

/// One step of modified curvature diffusion (Whitaker & Xue 2001): evens out noise along level
/// surfaces and stops at edges. `conductance` is relative to `gradient`, the root of the mean
/// squared gradient [per voxel] of all that is diffused. A voxel acts on its 26 neighbours.
[[nodiscard]] GrayVolume curvature_diffused(const GrayVolume& gray, double gradient,
                                            double conductance);
/// The median of the 3 x 3 x 3 voxels around each.
[[nodiscard]] GrayVolume median_filtered(const GrayVolume& gray);

/// The threshold that separates two classes of gray best (Otsu 1979), from a histogram of equal
/// bins between `low` and `high`.
[[nodiscard]] double otsu_threshold(std::span<const std::uint64_t> counts, double low, double high);

/// Void that no path through void connects to the volume's border becomes solid.
[[nodiscard]] MaskVolume holes_filled(const MaskVolume& mask);
/// Morphological opening with a ball of this radius [voxels].
[[nodiscard]] MaskVolume opened(const MaskVolume& mask, std::uint32_t radius);

/// Distance of each solid voxel's centre to the nearest void voxel's [voxels]; 0 in void. Exact
/// (Maurer et al. 2003).
[[nodiscard]] GrayVolume depth_in_solid(const MaskVolume& mask);

/// Splits solid at its necks: a watershed of the depth (flooding from the deepest places), seeded
/// by those maxima that rise by more than `least_rise` [voxels] above any pass to a higher one
/// (h-maxima). Numbers are from 1, in the order of the seeds' first voxels.
[[nodiscard]] LabelVolume split_at_necks(const GrayVolume& depth, double least_rise);

/// A picture: three bytes (red, green, blue) a pixel, rows from the top.
void write_png(const std::filesystem::path& file, std::int32_t width, std::int32_t height,
               const std::vector<std::uint8_t>& rgb);

}  // namespace reckon
