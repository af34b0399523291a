// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/creases.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "reckon/avatar/half_edges.hpp"

namespace reckon {
namespace {

/// The sharp edges and how they meet at vertices.
class SharpEdges {
 public:
  explicit SharpEdges(const TriangleMesh& mesh) : mesh_{mesh}, at_(mesh.vertices.size()) {
    const std::vector<HalfEdge> half = sorted_half_edges(mesh);
    for (std::size_t e = 1; e < half.size(); ++e) {
      if (!half[e].same_edge(half[e - 1])) continue;
      // Written so that a triangle without area, which has no normal, makes no crease.
      if (!(dot(normal(half[e].triangle), normal(half[e - 1].triangle)) < crease_cosine)) continue;
      const auto index = static_cast<std::uint32_t>(ends_.size());
      ends_.push_back({half[e].low, half[e].high});
      at_[half[e].low].push_back(index);
      at_[half[e].high].push_back(index);
    }
    used_.assign(ends_.size(), false);
  }

  std::vector<Crease> creases() {
    std::vector<Crease> found;
    for (std::uint32_t v = 0; v < at_.size(); ++v) {
      if (!ends_crease(v)) continue;
      for (const std::uint32_t edge : at_[v]) {
        if (!used_[edge]) found.push_back(follow(v, edge));
      }
    }
    for (std::uint32_t edge = 0; edge < ends_.size(); ++edge) {  // what is left are rings
      if (!used_[edge]) found.push_back(follow(ends_[edge][0], edge));
    }
    return found;
  }

 private:
  [[nodiscard]] Vec3 normal(std::uint32_t triangle) const {
    return normalized(doubled_area_vector(mesh_, mesh_.triangles[triangle]));
  }
  [[nodiscard]] std::uint32_t other_end(std::uint32_t edge, std::uint32_t vertex) const {
    return ends_[edge][0] == vertex ? ends_[edge][1] : ends_[edge][0];
  }
  [[nodiscard]] bool ends_crease(std::uint32_t vertex) const {
    const std::vector<std::uint32_t>& edges = at_[vertex];
    if (edges.empty()) return false;
    if (edges.size() != 2) return true;
    const Vec3& here = mesh_.vertices[vertex];
    const Vec3 in = normalized(here - mesh_.vertices[other_end(edges[0], vertex)]);
    const Vec3 out = normalized(mesh_.vertices[other_end(edges[1], vertex)] - here);
    return dot(in, out) < crease_cosine;
  }

  Crease follow(std::uint32_t vertex, std::uint32_t edge) {
    Crease crease;
    crease.vertices.push_back(vertex);
    const std::uint32_t start = vertex;
    for (;;) {
      used_[edge] = true;
      vertex = other_end(edge, vertex);
      if (vertex == start && !ends_crease(vertex)) {
        crease.closed = true;
        return crease;
      }
      crease.vertices.push_back(vertex);
      if (ends_crease(vertex)) return crease;
      edge = at_[vertex][0] == edge ? at_[vertex][1] : at_[vertex][0];
    }
  }

  const TriangleMesh& mesh_;
  std::vector<std::array<std::uint32_t, 2>> ends_;  // of each sharp edge
  std::vector<std::vector<std::uint32_t>> at_;      // sharp edges of each vertex
  std::vector<bool> used_;
};

}  // namespace

std::vector<Crease> creases_of(const TriangleMesh& mesh) { return SharpEdges{mesh}.creases(); }

std::vector<Vec3> line_along(const TriangleMesh& mesh, const Crease& crease) {
  std::vector<Vec3> line;
  line.reserve(crease.vertices.size() + 1);
  for (const std::uint32_t vertex : crease.vertices) line.push_back(mesh.vertices[vertex]);
  if (crease.closed) line.push_back(line.front());
  return line;
}

std::vector<Vec3> points_on_creases(const TriangleMesh& mesh, const std::vector<Crease>& creases,
                                    double spacing) {
  std::vector<Vec3> points;
  std::vector<bool> corner_taken(mesh.vertices.size(), false);
  const auto add_corner = [&](std::uint32_t vertex) {
    if (!corner_taken[vertex]) points.push_back(mesh.vertices[vertex]);
    corner_taken[vertex] = true;
  };
  for (const Crease& crease : creases) {
    const std::vector<Vec3> line = line_along(mesh, crease);
    std::vector<double> along{0};
    for (std::size_t v = 1; v < line.size(); ++v) {
      along.push_back(along.back() + norm(line[v] - line[v - 1]));
    }
    const double length = along.back();
    if (length < 0.5 * spacing) continue;
    const double wanted = std::round(length / spacing);
    const auto pieces = static_cast<std::size_t>(std::max(crease.closed ? 3.0 : 1.0, wanted));
    if (!crease.closed) {
      add_corner(crease.vertices.front());
      add_corner(crease.vertices.back());
    }
    std::size_t segment = 1;
    for (std::size_t p = crease.closed ? 0 : 1; p < pieces; ++p) {
      const double place = length * static_cast<double>(p) / static_cast<double>(pieces);
      while (segment + 1 < along.size() && along[segment] < place) ++segment;
      const double share = (place - along[segment - 1]) / (along[segment] - along[segment - 1]);
      points.push_back(line[segment - 1] + share * (line[segment] - line[segment - 1]));
    }
  }
  return points;
}

}  // namespace reckon
