// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "reckon/scan/scan_avatars.hpp"
#include "reckon/scan/volume.hpp"

namespace reckon {

/// The truth of a simulated scan.
struct ScanTruth {
  ShapeLibrary shapes;
  std::vector<GrainState> grains;  ///< shape by place in `shapes`, in the volume's world frame
  LabelsOnDisk labels;             ///< n stands for grain n - 1
};

/// How near the avatars come to the truth. Means are over the grains that were found once.
struct TruthFigures {
  std::uint32_t grains{0};  ///< true grains that the scan shows whole
  /// Of those: one avatar shares more than half of both voxels, and neither is split or joined.
  std::uint32_t found_once{0};
  std::uint32_t split{0};           ///< several avatars share a tenth of it or more
  std::uint32_t joined{0};          ///< labels that hold a tenth of several grains or more
  double voxels_per_diameter{0};    ///< of the mean grain
  double volume_error{0};           ///< mean of V / V_true - 1
  double volume_error_absolute{0};  ///< mean of |V / V_true - 1|
  double inertia_error{0};          ///< mean over grains and axes of |I / I_true - 1|
  double center_error{0};           ///< mean distance of the centres [voxels]
  double axis_error{0};             ///< mean angle of the long axes where the moments differ [rad]
  double surface_error{0};          ///< mean |phi_true| at the avatars' nodes [voxels]
  double normal_error{0};           ///< mean angle to the true normal at the avatars' nodes [rad]
  std::uint32_t true_contacts{0};   ///< between grains that the scan shows whole, found or not
  std::uint32_t found_contacts{0};  ///< of avatars, but for those of grains that are cut off
  std::uint32_t right_contacts{0};  ///< of grains found once, both

  [[nodiscard]] double recall() const;
  [[nodiscard]] double precision() const;
};

/// `labels` are those that the avatars were made of (AvatarQuality::label). Volumes and moments of
/// the true grains are those inside the zero surface of the interpolated grid, which was scanned.
[[nodiscard]] TruthFigures compare_with_truth(const ScanTruth& truth,
                                              const ScannedAssembly& assembly,
                                              const LabelsOnDisk& labels, const Workspace& work);

}  // namespace reckon
