// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/half_edges.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>

namespace reckon {

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
  // Few edges share their lower vertex: they are put in line by it, and sorted among each other.
  const auto for_each = [&](auto&& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::uint8_t side = 0; side < 3; ++side) {
        const std::uint32_t from = mesh.triangles[t][side];
        const std::uint32_t to = mesh.triangles[t][(side + 1U) % 3U];
        visit(HalfEdge{std::min(from, to), std::max(from, to), t, side, from < to});
      }
    }
  };
  std::vector<std::size_t> first(mesh.vertices.size() + 1, 0);
  for_each([&](const HalfEdge& edge) { ++first[edge.low + 1]; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<HalfEdge> edges(3 * mesh.triangles.size());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for_each([&](const HalfEdge& edge) { edges[next[edge.low]++] = edge; });
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    const auto at = [&](std::size_t place) {
      return edges.begin() + static_cast<std::ptrdiff_t>(place);
    };
    std::sort(at(first[v]), at(first[v + 1]), [](const HalfEdge& a, const HalfEdge& b) {
      return std::tie(a.high, a.triangle, a.side) < std::tie(b.high, b.triangle, b.side);
    });
  }
  return edges;
}

}  // namespace reckon
