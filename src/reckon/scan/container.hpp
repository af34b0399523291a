// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/scan/specimen.hpp"

namespace reckon {

/// Finds walls that stand along z (a tube, a box, arcs of either in the corners) and floors or lids
/// across it, and makes them void; also what lies outside a closed wall. Remarks state what was
/// found.
///
/// A line of voxels along z that is bright in nearly all layers belongs to a wall, as a packing has
/// void everywhere; a layer that is bright nearly all over belongs to a floor. Beside them the
/// blurred wall adds to the gray: the amount is measured where there is no grain, from the lower
/// fifth of the values of a line, or a layer.
void remove_container(Specimen& specimen, const Workspace& work);

}  // namespace reckon
