// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/scan/specimen.hpp"

namespace reckon {

/// Brings the gray of void, and that of solid, to one level all over the specimen, if one of them
/// changes by more than a few percent of the step between them.
///
/// The volume is cut into cells that are larger than a few grains. In each, Otsu's threshold
/// divides the voxels, and the medians of both classes are the gray of void and of solid there.
/// Polynomials of third degree go through these medians; cells that hold one phase only, or whose
/// medians are far off, are left out of the fit. What is left of a value is its share between both
/// polynomials. Additive shading, multiplicative shading, and cupping with or without the void are
/// all of this kind.
void level_gray(Specimen& specimen, const Workspace& work);

}  // namespace reckon
