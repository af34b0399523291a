// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "reckon/domain/shape_store.hpp"
#include "reckon/grains/grains.hpp"
#include "reckon/grains/periodic_cell.hpp"

namespace reckon {

/// Contacts are found by the surface nodes of one grain in the level set of the other. Of grains
/// that stand inside each other these nodes see nothing, or push the wrong way:
///
///    ,-----------.
///    |   ,--.    |      no node of either grain is near the surface of the other
///    |   `--'    |
///    `-----------'
///
/// So a placement is tested by geometry, before contacts are asked.

/// Grains of one shape in one pose, sorted by id: two or more.
using Copies = std::vector<GrainId>;
[[nodiscard]] std::vector<Copies> find_copies(std::span<const GrainState> grains);

/// A grain whose core lies inside another. The core is the centre of mass where that is in the
/// grain's solid, else the deepest point of its level set; so it also lies inside the other when
/// all of the grain's surface does.
struct GrainInside {
  GrainId inner;
  GrainId outer;
  double depth{0};  ///< of the core below the surface of `outer` [m]
};

/// Sorted by ids, each pair once, at most `most`. `radii` of bounding spheres and grids come from
/// `outlines`, by ShapeId; `read` brings the shapes of grains that stand so close that only their
/// level sets can tell. Copies count once. Memory follows the grains, not their pairs.
[[nodiscard]] std::vector<GrainInside> find_grains_inside(std::span<const GrainState> grains,
                                                          std::span<const ShapeOutline> outlines,
                                                          const ShapeStore::Read& read,
                                                          const PeriodicCell* cell,
                                                          std::size_t most);

}  // namespace reckon
