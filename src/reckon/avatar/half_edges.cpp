// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/half_edges.hpp"

#include <algorithm>
#include <tuple>

namespace reckon {

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint8_t side = 0; side < 3; ++side) {
      const std::uint32_t from = mesh.triangles[t][side];
      const std::uint32_t to = mesh.triangles[t][(side + 1U) % 3U];
      edges.push_back({std::min(from, to), std::max(from, to), t, side, from < to});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle, a.side) <
           std::tie(b.low, b.high, b.triangle, b.side);
  });
  return edges;
}

}  // namespace reckon
