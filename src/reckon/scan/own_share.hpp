// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/scan/volume.hpp"

namespace reckon {

/// Solid around one grain, divided between it and its neighbours.
struct OwnShare {
  GrayVolume share;  ///< solid shares that are the grain's own, blurred as they were scanned
  GrayVolume part;   ///< 1 in the grain and 0 in its neighbours; 1/2 on the border between them
};

/// The part of solid shares that belongs to a grain. `ownership`: 1 in voxels labelled as the
/// grain, 0 in its neighbours, 1/2 in void. `blur`: its standard deviation at the edges [voxels];
/// for edges of 0.95 voxels, anything from 0.8 to 1.1 finds the same surfaces.
///
/// Blur fills the narrow void around a contact from both sides, and labels end in staircases.
/// Therefore
/// 1. the scanner's blur is undone: shares between 0 and 1 are sought which, blurred, are those
///    that were scanned (Landweber's iteration, projected);
/// 2. the border between the labels moves through the sharp solid by its curvature (Merriman, Bence
///    & Osher 1992): blur what is the grain's, and assign each place to the side with the larger
///    share. Void has no weight, so the border becomes a film across the necks between grains;
/// 3. what lies beyond the border, blurred again, is subtracted. The result is like a scan of the
///    grain alone.
[[nodiscard]] OwnShare own_share(GrayVolume share, const GrayVolume& ownership, double blur);

}  // namespace reckon
