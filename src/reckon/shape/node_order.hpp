// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "reckon/shape/shape.hpp"

namespace reckon {

/// An order of points in which every run of `leaf` points that starts at a multiple of `leaf` is
/// compact, and so is every aligned run of 2, 4, 8, ... such runs: the leaves of a tree of boxes,
/// each cut across its longest side. Element n is the place of the n-th point in `points`. Equal
/// coordinates are told apart by place, so the order depends on nothing but the points.
[[nodiscard]] std::vector<std::uint32_t> compact_order(std::span<const Vec3> points,
                                                       std::uint32_t leaf);

/// Nodes in the compact_order that fits make_clusters.
[[nodiscard]] SurfaceNodes in_compact_order(const SurfaceNodes& nodes);

}  // namespace reckon
