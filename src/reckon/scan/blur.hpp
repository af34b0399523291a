// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "reckon/scan/volume.hpp"

namespace reckon {

/// A Gaussian filter of this standard deviation [voxels], edges continued; 0 changes nothing.
void blur_volume(GrayVolume& volume, double deviation);
/// How far voxels act on each other in it [voxels].
[[nodiscard]] std::int32_t blur_reach(double deviation);

}  // namespace reckon
