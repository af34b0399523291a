// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "reckon/scan/segmentation.hpp"

/// Figures of a whole volume, of which a part is read at a time. None depends on the parts.
namespace reckon {

/// The threshold that separates two classes of gray best (Otsu 1979), from 256 bins between the
/// 0.1 % darkest and brightest voxels. Throws Error when these are the same.
[[nodiscard]] double otsu_threshold(const GrayOnDisk& gray, const Workspace& work);

/// Root of the mean squared gradient by central differences [per voxel]; the outermost voxels count
/// twice where there is no further one.
[[nodiscard]] double mean_gradient(const GrayOnDisk& gray, const Workspace& work);

/// Mean gray values deep inside void and solid, or of all of a phase where there is too little of
/// that. `solid_of` gives the solid voxels of a part. Throws Error when one phase is missing;
/// `threshold` is used only in its text.
[[nodiscard]] GrayLevels phase_levels(const GrayOnDisk& gray,
                                      const std::function<MaskVolume(const GrayVolume&)>& solid_of,
                                      double threshold, const Workspace& work);

}  // namespace reckon
