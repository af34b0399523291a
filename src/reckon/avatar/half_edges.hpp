// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// One side of one triangle. Side s runs from corner s to corner (s + 1) mod 3.
struct HalfEdge {
  std::uint32_t low{0};       ///< the lower of its two vertices
  std::uint32_t high{0};      ///< the higher of its two vertices
  std::uint32_t triangle{0};  ///< the triangle it belongs to
  std::uint8_t side{0};       ///< which side of that triangle: 0, 1 or 2
  bool ascending{true};       ///< the triangle walks it from low to high

  [[nodiscard]] bool same_edge(const HalfEdge& other) const {
    return low == other.low && high == other.high;
  }
};

/// All sides of all triangles, sorted by edge (low, high), then by triangle and side: the half
/// edges of one edge stand together. In a closed surface they come in pairs, one of which ascends.
[[nodiscard]] std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh);

}  // namespace reckon
