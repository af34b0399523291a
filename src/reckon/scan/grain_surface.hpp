// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/scan/labels.hpp"
#include "reckon/scan/segmentation.hpp"
#include "reckon/scan/volume.hpp"

namespace reckon {

/// How many layers beyond its labelled voxels the blurred edge of a grain is searched.
inline constexpr int territory_layers = 3;

/// What grains are cut out of.
struct SegmentedScan {
  const GrayVolume* raw{nullptr};       ///< as scanned: gives volumes
  const GrayVolume* denoised{nullptr};  ///< gives surfaces
  const LabelVolume* labels{nullptr};
  const LabelVolume* territories{nullptr};  ///< labels, grown by territory_layers
  GrayLevels levels;
};

/// A grain's surface and how far it changed on the way.
struct GrainSurface {
  TriangleMesh mesh_world;  ///< closed, outward, in the volume's world frame
  double label_volume{0};   ///< of its voxels [m^3]
  double gray_volume{0};    ///< its solid shares summed up, which blur does not change [m^3]
  double solid_gray{0};     ///< mean gray value deep inside it
  double level{0};          ///< the solid share at which its surface is drawn
};

/// A grain's surface from gray values, not from the staircase of its voxels.
///
/// - Gray values become solid shares f between the volume's void and the grain's own solid, so that
///   a shading over the volume (beam hardening) does not move the surface.
/// - What neighbours add to f is subtracted (own_share). The surface crosses the border with them
///   nowhere.
/// - `smoothing` [voxels] is the deviation of a Gaussian on f. Drawing a level of a diffused
///   indicator anew moves the surface by its curvature (Merriman, Bence & Osher 1992): it is
///   curvature flow for a time smoothing^2 / 2.
/// - Smoothing and the scanner's blur flatten relief. Some of it comes back by adding `sharpening`
///   times what a further smoothing by one voxel would take away. For waves that are long against
///   the blur, smoothing^2 plus the square of the blur's deviation undoes both; noise, which is
///   shorter, grows less than it does with less smoothing.
/// - Blur, the scanner's and this one, moves a convex surface inwards. The level is therefore
///   chosen such that the enclosed volume is that of the summed solid shares, within [0.25, 0.75].
///
/// Throws Error when no surface is left.
[[nodiscard]] GrainSurface extract_grain(const SegmentedScan& scan, std::uint32_t label,
                                         const LabelledGrain& grain, double smoothing,
                                         double sharpening);

/// The connected part of a mesh with the largest volume.
[[nodiscard]] TriangleMesh largest_component(TriangleMesh mesh);

}  // namespace reckon
