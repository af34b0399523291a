// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "reckon/grains/grains.hpp"
#include "reckon/scan/volume.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// What spoils scans, in units of the step from void to solid; 0 or less: absent.
struct ScanArtefacts {
  double tube{0};          ///< gray of a tube around the grains, which the outermost touch
  double floor{0};         ///< gray of a floor under the grains, which the lowest touch
  double circle{0};        ///< 1: outside a circle of reconstruction the gray is constant
  double circle_gray{0};   ///< that gray, as it stands in the volume
  double shading{0};       ///< added to the gray along x, from one side to the other
  double gain_shading{0};  ///< share by which the gray above black changes along x, in the same way
  double cupping{0};       ///< share of the gray above black that the axis loses, void included
  double rings{0};         ///< deviation of rings about the axis
  double mineral_share{0};  ///< of the grains, that are of another mineral
  double mineral_gray{0.4};
  double crack_share{0};  ///< of the grains, that have a plane crack through the middle
  double crack_width{1};  ///< [voxels]
};

/// The imaging of solid by a scanner. Gray values are in units of the step from void to solid.
struct ScannerSettings {
  double voxel{0};            ///< edge of a voxel [m]
  double margin{4};           ///< void around the grains; a tube or a floor needs more [voxels]
  bool partial_volume{true};  ///< a voxel's value is its solid share; else its centre decides
  double blur{0.8};           ///< standard deviation of the point spread function [voxels]
  double noise{0.05};         ///< standard deviation of the white noise
  double beam_hardening{0};   ///< share of its value that solid on the volume's axis loses
  double void_gray{10000};
  double solid_gray{40000};
  std::uint64_t seed{1};
  ScanArtefacts artefacts;

  static constexpr double tube_width = 5;  ///< of tube and floor [voxels]

  /// Throws Error naming the setting that is out of range.
  void validate() const;
};

/// Brings a shape with its grid.
using ReadShape = std::function<Shape(ShapeId)>;

/// Layers across z of a scan, and which grain each voxel belongs to: its place in
/// Scanner::grains(), from 1.
struct ScannedLayers {
  GrayVolume gray;
  LabelVolume labels;
};

/// A grain as the scanner meets it.
struct ScannedBody;

/// Scans an assembly: what an X-ray tomograph would make of it.
///
/// 1. Solid share of each voxel: 4 x 4 x 4 points in each voxel near a surface are looked up in
///    the interpolated grids, so grains that overlap do not count twice.
/// 2. Beam hardening: cupping about the volume's axis along z, where a share b of the solid's gray
///    is lost: factor 1 - b (1 - (r/R)^2), with R the volume's half diagonal across z.
/// 3. The point spread function, a Gaussian.
/// 4. White Gaussian noise, a function of seed and voxel.
///
/// Artefacts: minerals, cracks, tube and floor come before the point spread function; cupping,
/// shading, rings and the circle behind it.
///
/// The volume holds all grains and a margin. Any part of it can be scanned separately, with the
/// same bits as in the whole.
class Scanner {
 public:
  /// Throws Error when there are no grains or the volume would have more than 2^31 voxels.
  Scanner(const std::vector<GrainState>& grains, const ReadShape& read_shape,
          const ScannerSettings& settings);
  ~Scanner();
  Scanner(const Scanner&) = delete;
  Scanner& operator=(const Scanner&) = delete;

  [[nodiscard]] const VoxelDims& dims() const { return dims_; }
  /// As scanned, in the volume's world frame.
  [[nodiscard]] const std::vector<GrainState>& grains() const { return grains_; }
  /// How many layers on either side are worked out, and dropped, along with those that are scanned:
  /// as far as the blur reaches.
  [[nodiscard]] std::int32_t margin() const;
  /// Whole layers. Uses all threads; the result does not depend on their number.
  [[nodiscard]] ScannedLayers scan(const Box& slab) const;

 private:
  void place_container();

  ScannerSettings settings_;
  VoxelDims dims_{0, 0, 0};
  std::vector<GrainState> grains_;
  std::map<ShapeId, Shape> shapes_;
  std::vector<ScannedBody> bodies_;
  double tube_radius_{0};  // its inner surface about the volume's axis [voxels]
  double floor_top_{0};    // [voxels]
};

/// A complete scan and its truth.
struct SimulatedScan {
  GrayVolume gray;
  LabelVolume labels;
  std::vector<GrainState> grains;
};
[[nodiscard]] SimulatedScan scan_assembly(const std::vector<GrainState>& grains,
                                          const ReadShape& read_shape,
                                          const ScannerSettings& settings);

}  // namespace reckon
