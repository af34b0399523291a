// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reckon/scan/disk_volume.hpp"
#include "reckon/scan/volume_file.hpp"

namespace reckon {

struct SpecimenSettings {
  std::filesystem::path mask;  ///< volume whose voxels above 0 are the specimen; empty: search
  bool keep_container{false};  ///< do not look for walls and floors
  bool keep_shading{false};    ///< do not level background and gain
};

/// What of a volume is the specimen, and its gray values with the rest made void.
struct Specimen {
  MaskOnDisk outer;   ///< 1: within the scanned region, or the given mask; empty: all
  MaskOnDisk inside;  ///< 1: likewise, and no container; empty: all
  GrayOnDisk gray;
  std::vector<std::string> remarks;
};

/// Cleans a scan for what follows, which expects grains in void of one gray.
///
/// 1. Voxels outside are excluded: by a given mask, or voxels of one constant gray that fill
///    the vertical edges of the volume and are connected to them (outside a circle of
///    reconstruction).
/// 2. Walls and floors are found as lines of voxels across the volume, or layers of it, that are
///    bright nearly all along, as no packing of grains is. They become void; what they add to the
///    gray of voxels beside them is subtracted.
/// 3. Where the gray of void or solid changes over the volume by more than a few percent of the
///    step between them, both are brought to one level (leveling.hpp).
///
/// A volume without any of this stays as it is, to the last bit.
[[nodiscard]] Specimen find_specimen(const GrayOnDisk& raw, const SpecimenSettings& settings,
                                     const Workspace& work);

/// The first step alone: empty when all of the volume is the specimen.
[[nodiscard]] MaskOnDisk find_inside(const GrayOnDisk& raw, const SpecimenSettings& settings,
                                     const Workspace& work, std::vector<std::string>& remarks);

/// Otsu's two classes of the specimen's voxels.
struct RoughLevels {
  double threshold{0};
  double void_gray{0};  ///< where a class is densest; from a histogram alone, its median
  double solid_gray{0};
  [[nodiscard]] double step() const { return solid_gray - void_gray; }
};
[[nodiscard]] RoughLevels rough_levels(const GrayOnDisk& gray, const MaskOnDisk& inside,
                                       const Workspace& work);
/// Likewise from a histogram of equal bins between `low` and `high`.
[[nodiscard]] RoughLevels rough_levels(const std::vector<std::uint64_t>& counts, double low,
                                       double high);

}  // namespace reckon
