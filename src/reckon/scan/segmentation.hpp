// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "reckon/scan/volume.hpp"

namespace reckon {

enum class Denoising : std::uint8_t { none, median, curvature };

struct DenoiseSettings {
  Denoising method{Denoising::curvature};
  std::uint32_t iterations{5};  ///< of curvature diffusion
  double conductance{1};        ///< likewise
};

struct MaskSettings {
  std::optional<double> threshold;  ///< absent: found from the gray values
  bool fill{true};                  ///< voids inside grains become solid
  std::uint32_t open_radius{0};     ///< of the ball that opens the mask; 0: none [voxels]
};

struct SplitSettings {
  double least_rise{0.5};  ///< of a grain's middle above its deepest pass [voxels]
  double neck{0.95};       ///< NeckRules::wide
  double neck_void{0.03};  ///< NeckRules::largest_void
};

/// Gray values of what a scan consists of.
struct GrayLevels {
  double threshold{0};
  double void_gray{0};
  double solid_gray{0};

  /// The solid share that a gray value stands for.
  [[nodiscard]] double share(double gray) const {
    return (gray - void_gray) / (solid_gray - void_gray);
  }
};

[[nodiscard]] GrayVolume denoised(const GrayVolume& gray, const DenoiseSettings& settings);

struct SolidMask {
  MaskVolume mask;
  GrayLevels levels;
};
/// Void and solid. Without a given threshold, Otsu's comes first; the means of what lies more than
/// 2.5 voxels from its surface are the gray levels, and half way between them is the threshold.
/// Throws Error when there is no solid or no void.
[[nodiscard]] SolidMask find_solid(const GrayVolume& gray, const MaskSettings& settings);

struct SplitGrains {
  LabelVolume labels;       ///< consecutive from 1, in the order of their first voxels
  std::uint32_t joined{0};  ///< pieces that join_wide_necks put together again
};
/// `gray` (as scanned, or null) and its levels tell necks that are solid from touching grains.
/// Throws Error when nothing is found, or one blob reaches all through the volume.
[[nodiscard]] SplitGrains split_grains(const MaskVolume& mask, const SplitSettings& settings,
                                       const GrayVolume* gray = nullptr,
                                       const GrayLevels& levels = {});

/// The levels of a gray volume whose grains are known already.
[[nodiscard]] GrayLevels levels_of(const GrayVolume& gray, const MaskVolume& mask,
                                   double threshold);

}  // namespace reckon
