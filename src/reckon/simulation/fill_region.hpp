// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reckon/grains/grains.hpp"
#include "reckon/shape/shape.hpp"
#include "reckon/simulation/config.hpp"

namespace reckon {

/// Grains in random orientations on a jittered grid that fills the region from below, bounding
/// spheres apart. Shapes are drawn evenly from `shapes`, whose first is `first_shape` of the run's
/// library; ids start at `first_id`. Depends on nothing but its arguments. Throws Error when the
/// region cannot hold the count.
[[nodiscard]] std::vector<GrainState> fill_region(const FillPlacement& fill,
                                                  std::span<const ShapeView> shapes,
                                                  ShapeId first_shape, GrainId first_id,
                                                  std::uint64_t seed);

/// A rotation drawn evenly from all rotations (Shoemake 1992) for one grain.
[[nodiscard]] Quaternion random_orientation(std::uint64_t seed, GrainId grain);

}  // namespace reckon
