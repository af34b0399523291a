// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reckon/scan/blocks.hpp"
#include "reckon/scan/disk_volume.hpp"
#include "reckon/scan/labels.hpp"

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
  std::uint32_t phases{0};    ///< of solid that are looked for: 1, or 0 for as many as there are
  std::vector<double> grays;  ///< of void and of each solid, rising; empty: found
};

struct SplitSettings {
  double least_rise{0.5};  ///< of a grain's middle above its deepest pass [voxels]
  double neck{0.95};       ///< NeckRules::wide
  double neck_void{0.03};  ///< NeckRules::largest_void
};

/// How void, solid and the edges between them look in a scan.
struct GrayLevels {
  double threshold{0};
  double void_gray{0};
  double solid_gray{0};
  double blur{0.95};  ///< deviation of an edge's, once denoised: usual for scans [voxels]

  /// The solid share of a gray value.
  [[nodiscard]] double share(double gray) const {
    return (gray - void_gray) / (solid_gray - void_gray);
  }
};

/// The results below do not depend on how a volume is cut into blocks.

[[nodiscard]] GrayOnDisk denoised(const GrayOnDisk& gray, const DenoiseSettings& settings,
                                  const Workspace& work);

struct SolidMask {
  MaskOnDisk mask;
  GrayLevels levels;
  std::vector<double> phases;  ///< grays of solid, rising; one unless several were found
};
/// Void and solid. Without a given threshold, Otsu's comes first; the means of what lies more than
/// 2.5 voxels from its surface are the gray levels, and half way between them is the threshold.
/// Where the gray values have several plateaus of solid (phases.hpp), a faint one has its own.
/// Throws Error when there is no solid or no void.
/// `inside`: what of the volume counts for the phases; empty: all.
[[nodiscard]] SolidMask find_solid(const GrayOnDisk& gray, const MaskSettings& settings,
                                   const Workspace& work, const MaskOnDisk& inside = {});

/// How a volume was split that is larger than memory.
struct BlockFigures {
  std::size_t blocks{1};
  std::int32_t overlap{0};    ///< of the blocks [voxels]
  std::uint64_t disputed{0};  ///< solid voxels that blocks give to different pieces, or to none
};

struct SplitGrains {
  LabelsOnDisk labels;        ///< consecutive from 1, in the order of their first voxels
  std::uint32_t joined{0};    ///< pieces that NeckJoiner put together again
  std::vector<Waist> waists;  ///< where, by label
  BlockFigures blocks;
};
/// Watershed of the depth below the surface, block by block: a piece is that of the block in whose
/// core it is deepest. Then pieces are joined that no neck divides. `gray` (as scanned, or null)
/// and its levels distinguish solid necks from touching grains. Throws Error when nothing is found,
/// when one body extends through the whole volume, or a piece reaches so near to a cut face of its
/// block that its depth there is not known.
[[nodiscard]] SplitGrains split_grains(const MaskOnDisk& mask, const SplitSettings& settings,
                                       const GrayOnDisk* gray, const GrayLevels& levels,
                                       const Workspace& work);

/// Throws Error when one of the phases has no voxels.
void require_both_phases(std::uint64_t solid, std::uint64_t voids, double threshold);

/// The levels of a gray volume whose grains are known already.
[[nodiscard]] GrayLevels levels_of(const GrayOnDisk& gray, const MaskOnDisk& mask, double threshold,
                                   const Workspace& work);

}  // namespace reckon
