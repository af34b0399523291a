// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "reckon/scan/disk_volume.hpp"
#include "reckon/scan/specimen.hpp"

namespace reckon {

/// Grays at which a scan has plateaus: void, and solid of one mineral or more.
struct GrayPhases {
  double void_gray{0};
  std::vector<double> solid;  ///< rising; the most common is `main`
  double main{0};

  /// The darkest solid, when half way between void and the main solid would lose it or spoil its
  /// edge.
  [[nodiscard]] std::optional<double> faint() const;
  /// Which of `solid` a grain's gray is nearest to, from 1.
  [[nodiscard]] std::uint32_t phase_of(double gray) const;
};

/// From the histogram of voxels whose neighbours have nearly the same gray, so that the blurred
/// edges between phases do not count. `gray`: after denoising.
[[nodiscard]] GrayPhases find_phases(const GrayOnDisk& gray, const MaskOnDisk& inside,
                                     const Workspace& work);

/// From grays of void and of each solid, which must rise. The brightest solid is taken for the main
/// one. Throws Error when fewer than two are given or they do not rise.
[[nodiscard]] GrayPhases given_phases(const std::vector<double>& grays);

/// The reach of faint_solid() [voxels].
inline constexpr std::int32_t faint_reach = 8;
/// Voxels of the faint phase: bodies of its gray that a ball of two voxels' radius fits into, and
/// their edges. The edges of brighter grains pass through the same grays but are thinner.
[[nodiscard]] MaskVolume faint_solid(const GrayVolume& gray, const GrayPhases& phases);

}  // namespace reckon
