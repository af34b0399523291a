// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/merge_corners.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "reckon/avatar/half_edges.hpp"
#include "reckon/avatar/mesh_reader.hpp"
#include "reckon/avatar/triangle_bvh.hpp"

namespace reckon {
namespace {

constexpr double rounding_of_size = 1e-5;
constexpr double rounding_of_coordinate = 1e-6;
constexpr double finest = 1e-12;  // of the largest coordinate: below lies double precision itself

struct Extent {
  double size{0};
  double largest_coordinate{0};
};
Extent extent_of(const TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  Extent extent;
  for (int axis = 0; axis < 3; ++axis) {
    extent.size = std::max(extent.size, box.high[axis] - box.low[axis]);
    extent.largest_coordinate =
        std::max({extent.largest_coordinate, std::abs(box.low[axis]), std::abs(box.high[axis])});
  }
  return extent;
}

/// The ends of edges that belong to one triangle only.
std::vector<bool> on_open_edges(const TriangleMesh& mesh) {
  std::vector<bool> open(mesh.vertices.size(), false);
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first + 1;
    while (last < edges.size() && edges[last].same_edge(edges[first])) ++last;
    if (last - first == 1) open[edges[first].low] = open[edges[first].high] = true;
    first = last;
  }
  return open;
}

/// Corners that stay, by cubic cell.
class KeptCorners {
 public:
  KeptCorners(const std::vector<Vec3>& vertices, double distance)
      : vertices_{vertices}, distance_{distance} {}

  /// The closest one within the distance of `vertex`, or `vertex` itself.
  [[nodiscard]] std::uint32_t closest_to(std::uint32_t vertex) const {
    const Vec3& place = vertices_[vertex];
    std::uint32_t best = vertex;
    double least = distance_ * distance_;
    const Cell center = cell_of(place);
    for (int n = 0; n < 27; ++n) {
      const auto found =
          cells_.find({center[0] + n % 3 - 1, center[1] + n / 3 % 3 - 1, center[2] + n / 9 - 1});
      if (found == cells_.end()) continue;
      for (const std::uint32_t kept : found->second) {
        const double squared = squared_norm(vertices_[kept] - place);
        if (squared > least || (squared == least && best != vertex)) continue;
        least = squared;
        best = kept;
      }
    }
    return best;
  }
  void add(std::uint32_t vertex) { cells_[cell_of(vertices_[vertex])].push_back(vertex); }

 private:
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] Cell cell_of(const Vec3& p) const {
    return {std::llround(p.x / distance_), std::llround(p.y / distance_),
            std::llround(p.z / distance_)};
  }

  const std::vector<Vec3>& vertices_;
  double distance_;
  std::map<Cell, std::vector<std::uint32_t>> cells_;
};

}  // namespace

std::string MergedCorners::text() const {
  std::string text = fmt::format("joined {} {} to another at most {:.3g} m away", merged,
                                 merged == 1 ? "corner" : "corners", largest_distance);
  if (lost_triangles > 0) text += fmt::format("; {} triangles vanished", lost_triangles);
  return text;
}

MergedCorners merge_corners(const TriangleMesh& mesh, std::optional<double> distance) {
  const Extent extent = extent_of(mesh);
  const double usual =
      std::max(rounding_of_size * extent.size, rounding_of_coordinate * extent.largest_coordinate);
  const double used = std::max(distance.value_or(usual), finest * extent.largest_coordinate);
  MergedCorners result{mesh, 0, 0, 0};
  if (!(used > 0)) return result;
  const std::vector<bool> candidate = on_open_edges(mesh);
  KeptCorners kept{mesh.vertices, used};
  std::vector<std::uint32_t> becomes(mesh.vertices.size());
  std::iota(becomes.begin(), becomes.end(), 0U);
  for (std::uint32_t v = 0; v < becomes.size(); ++v) {
    if (!candidate[v]) continue;
    becomes[v] = kept.closest_to(v);
    if (becomes[v] == v) {
      kept.add(v);
      continue;
    }
    ++result.merged;
    const double moved = norm(mesh.vertices[v] - mesh.vertices[becomes[v]]);
    result.largest_distance = std::max(result.largest_distance, moved);
  }
  if (result.merged == 0) return result;
  for (TriangleMesh::Triangle& triangle : result.mesh.triangles) {
    for (std::uint32_t& v : triangle) v = becomes[v];
  }
  result.mesh = welded(result.mesh);
  result.lost_triangles = mesh.triangles.size() - result.mesh.triangles.size();
  return result;
}

}  // namespace reckon
