// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/hole_filling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "reckon/avatar/half_edges.hpp"
#include "reckon/avatar/polygon_mesh.hpp"
#include "reckon/core/error.hpp"

namespace reckon {
namespace {

using Border = std::vector<std::uint32_t>;
using Triangle = TriangleMesh::Triangle;

constexpr std::size_t longest_exact = 300;  // corners: the search takes their number cubed
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

[[noreturn]] void refuse(const std::string& name, const TriangleMesh& mesh, const Border& border) {
  const Vec3& at = mesh.vertices[border.front()];
  throw Error{{.place = name,
               .problem = fmt::format("a hole of {} edges cannot be closed", border.size()),
               .reason = fmt::format("it begins near ({:.6g}, {:.6g}, {:.6g}) m", at.x, at.y, at.z),
               .fix = "Close it in a mesh editor."}};
}

/// The borders, each in the direction that triangles which close it walk it.
std::vector<Border> borders_of(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges,
                               const std::string& name) {
  std::vector<std::uint32_t> next(mesh.vertices.size(), none);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const bool paired = (e > 0 && edges[e].same_edge(edges[e - 1])) ||
                        (e + 1 < edges.size() && edges[e].same_edge(edges[e + 1]));
    if (paired) continue;
    const auto [from, to] = edges[e].ascending ? std::pair{edges[e].high, edges[e].low}
                                               : std::pair{edges[e].low, edges[e].high};
    next[from] = to;
  }
  std::vector<Border> borders;
  for (std::uint32_t start = 0; start < next.size(); ++start) {
    if (next[start] == none) continue;
    Border& border = borders.emplace_back();
    std::uint32_t v = start;
    while (next[v] != none) {
      border.push_back(v);
      v = std::exchange(next[v], none);
    }
    if (v != start) refuse(name, mesh, border);  // more than two triangles meet on its way
  }
  return borders;
}

/// Whether the surface has an edge between two corners.
bool has_edge(const std::vector<HalfEdge>& edges, std::uint32_t a, std::uint32_t b) {
  const auto [low, high] = std::minmax(a, b);
  const auto found = std::lower_bound(edges.begin(), edges.end(), std::pair{low, high},
                                      [](const HalfEdge& edge, const auto& key) {
                                        return std::pair{edge.low, edge.high} < key;
                                      });
  return found != edges.end() && found->low == low && found->high == high;
}

/// least(i, k): the least area of triangles that fill the border from corner i to corner k and the
/// chord between them; best(i, k): the corner that the chord's triangle takes.
class LeastArea {
 public:
  LeastArea(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges, const Border& border)
      : mesh_{mesh},
        border_{border},
        count_{border.size()},
        least_(count_ * count_, 0.0),
        best_(count_ * count_, 0) {
    for (std::size_t span = 2; span < count_; ++span) {
      for (std::size_t i = 0; i + span < count_; ++i) {
        const std::size_t k = i + span;
        double least = std::numeric_limits<double>::infinity();
        // A second edge between two corners would belong to four triangles.
        const bool closing = span + 1 == count_;
        if (closing || !has_edge(edges, border[i], border[k])) {
          for (std::size_t j = i + 1; j < k; ++j) {
            const double area = least_[at(i, j)] + least_[at(j, k)] + area_of(i, j, k);
            if (!(area < least)) continue;
            least = area;
            best_[at(i, k)] = j;
          }
        }
        least_[at(i, k)] = least;
      }
    }
  }

  [[nodiscard]] double area() const { return least_[at(0, count_ - 1)]; }

  void add_triangles(std::vector<Triangle>& triangles) const {
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, count_ - 1}};
    while (!open.empty()) {
      const auto [i, k] = open.back();
      open.pop_back();
      if (k - i < 2) continue;
      const std::size_t j = best_[at(i, k)];
      triangles.push_back({border_[i], border_[j], border_[k]});
      open.emplace_back(i, j);
      open.emplace_back(j, k);
    }
  }

 private:
  [[nodiscard]] std::size_t at(std::size_t i, std::size_t k) const { return i * count_ + k; }
  [[nodiscard]] double area_of(std::size_t i, std::size_t j, std::size_t k) const {
    return triangle_area(mesh_, {border_[i], border_[j], border_[k]});
  }

  const TriangleMesh& mesh_;
  const Border& border_;
  std::size_t count_;
  std::vector<double> least_;
  std::vector<std::size_t> best_;
};

/// The triangles between the corners of a long border, seen along the normal of its plane.
double clip_ears(const TriangleMesh& mesh, const Border& border, std::vector<Triangle>& triangles,
                 const std::string& name) {
  PolygonMesh polygon;
  std::vector<std::uint32_t> corners;
  for (const std::uint32_t v : border) {
    corners.push_back(static_cast<std::uint32_t>(corners.size()));
    polygon.vertices.push_back(mesh.vertices[v]);
  }
  polygon.add_face(corners);
  const TriangleMesh filling = triangulated(std::move(polygon), [&](std::size_t) {
    return fmt::format("{}, a hole of {} edges", name, border.size());
  });
  double area = 0;
  for (const TriangleMesh::Triangle& triangle : filling.triangles) {
    const auto& [a, b, c] = triangle;
    triangles.push_back({border[a], border[b], border[c]});
    area += triangle_area(filling, triangle);
  }
  return area;
}

}  // namespace

std::vector<FilledHole> fill_holes(TriangleMesh& mesh, const std::string& name) {
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
  std::vector<Triangle> filling;
  std::vector<FilledHole> holes;
  for (const Border& border : borders_of(mesh, edges, name)) {
    if (border.size() < 3) refuse(name, mesh, border);
    if (border.size() > longest_exact) {
      holes.push_back({border.size(), clip_ears(mesh, border, filling, name)});
      continue;
    }
    const LeastArea least{mesh, edges, border};
    if (!(least.area() < std::numeric_limits<double>::infinity())) refuse(name, mesh, border);
    least.add_triangles(filling);
    holes.push_back({border.size(), least.area()});
  }
  mesh.triangles.insert(mesh.triangles.end(), filling.begin(), filling.end());
  return holes;
}

}  // namespace reckon
