// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/surface_extraction.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>
#include <vector>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr double clearance = 1e-4;  // of mesh vertices from grid vertices [spacings]

// Corner c of a cell lies at (c & 1, c >> 1 & 1, c >> 2). Each face's corners are listed
// counter-clockwise as seen from outside the cell.
using Corner = unsigned;
constexpr std::array<std::array<Corner, 4>, 6> faces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

/// An edge of a cell is named 3 * (its lower corner) + (its axis).
constexpr std::size_t edge_names = 24;
constexpr std::size_t edge_name(Corner a, Corner b) {
  return 3 * std::min(a, b) + static_cast<unsigned>(std::countr_zero(a ^ b));
}

/// The faces that an edge lies on, as bits.
constexpr std::array<unsigned, edge_names> faces_of_edges() {
  std::array<unsigned, edge_names> of{};
  for (unsigned f = 0; f < 6; ++f) {
    for (unsigned s = 0; s < 4; ++s) {
      of[edge_name(faces[f][s], faces[f][(s + 1) % 4])] |= 1U << f;
    }
  }
  return of;
}
constexpr auto edge_faces = faces_of_edges();

/// For every cut edge the cut edge that follows it on its loop, counter-clockwise around the
/// surface as seen from outside the grain.
using Successors = std::array<std::size_t, edge_names>;

void link_face(const std::array<double, 8>& phi, const std::array<Corner, 4>& corners,
               Successors& next) {
  const auto inside = [&](unsigned s) { return phi[corners[s % 4]] < 0; };
  const auto edge = [&](unsigned s) { return edge_name(corners[s % 4], corners[(s + 1) % 4]); };
  const bool alternating =
      inside(0) != inside(1) && inside(1) != inside(2) && inside(2) != inside(3);
  if (alternating) {
    // The saddle of the bilinear interpolant is inside exactly when the product of the inside
    // corners is the larger one. Products of two floats are exact in double.
    const unsigned first_inside = inside(0) ? 0 : 1;
    const double product_inside = phi[corners[first_inside]] * phi[corners[first_inside + 2]];
    const double product_outside =
        phi[corners[first_inside + 1]] * phi[corners[(first_inside + 3) % 4]];
    const bool inside_connected = product_inside > product_outside;
    for (const unsigned s : {first_inside, first_inside + 2}) {
      // Side s + 3 enters corner s, side s leaves it.
      const std::size_t entry = edge(s + 3);
      next[entry] = inside_connected ? edge(s + 2) : edge(s);
    }
    return;
  }
  std::size_t entry = edge_names;
  std::size_t exit = edge_names;
  for (unsigned s = 0; s < 4; ++s) {
    if (inside(s) && !inside(s + 1)) exit = edge(s);
    if (!inside(s) && inside(s + 1)) entry = edge(s);
  }
  if (entry != edge_names) next[entry] = exit;
}

class Extractor {
 public:
  explicit Extractor(const LevelSetView& grid)
      : grid_{grid},
        row_{static_cast<std::size_t>(grid.dims[0])},
        slab_{row_ * static_cast<std::size_t>(grid.dims[1])},
        edge_vertex_{std::vector<std::uint32_t>(3 * slab_, none),
                     std::vector<std::uint32_t>(3 * slab_, none)} {}

  TriangleMesh run() {
    std::vector<unsigned char> inside_corners(row_);  // of the four on edges along y and z
    for (std::int32_t k = 0; k + 1 < grid_.dims[2]; ++k) {
      for (std::int32_t j = 0; j + 1 < grid_.dims[1]; ++j) {
        const float* const low = &grid_.values[index(0, j, k)];
        const float* const high = low + slab_;
        for (std::size_t i = 0; i < row_; ++i) {
          inside_corners[i] = static_cast<unsigned char>((low[i] < 0) + (low[i + row_] < 0) +
                                                         (high[i] < 0) + (high[i + row_] < 0));
        }
        for (std::size_t i = 0; i + 1 < row_; ++i) {
          const int count = inside_corners[i] + inside_corners[i + 1];
          if (count != 0 && count != 8) add_cell(static_cast<std::int32_t>(i), j, k);
        }
      }
      edge_vertex_[0].swap(edge_vertex_[1]);
      std::fill(edge_vertex_[1].begin(), edge_vertex_[1].end(), none);
    }
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::size_t index(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return static_cast<std::size_t>(i) + row_ * static_cast<std::size_t>(j) +
           slab_ * static_cast<std::size_t>(k);
  }

  void add_cell(std::int32_t i, std::int32_t j, std::int32_t k) {
    base_ = index(i, j, k);
    std::array<double, 8> phi{};
    for (Corner c = 0; c < 8; ++c) phi[c] = grid_.values[vertex_index(c)];
    Successors next;
    next.fill(edge_names);
    for (const auto& corners : faces) link_face(phi, corners, next);
    for (std::size_t start = 0; start < edge_names; ++start) {
      std::vector<std::size_t>& loop = loop_;
      loop.clear();
      for (std::size_t e = start; e != edge_names && next[e] != edge_names;) {
        loop.push_back(e);
        e = std::exchange(next[e], edge_names);
      }
      if (loop.size() >= 3) fill(loop, i, j, k);
    }
  }

  [[nodiscard]] std::size_t vertex_index(Corner c) const {
    return base_ + (c & 1U) + row_ * (c >> 1U & 1U) + slab_ * (c >> 2U);
  }

  /// The mesh vertex on an edge of the current cell, made at first use.
  std::uint32_t vertex_on(std::size_t edge, std::int32_t i, std::int32_t j, std::int32_t k) {
    const auto corner = static_cast<Corner>(edge / 3);
    const std::size_t axis = edge % 3;
    const std::size_t from = vertex_index(corner);
    std::uint32_t& vertex =
        edge_vertex_[corner >> 2U]
                    [3 * (from - slab_ * (static_cast<std::size_t>(k) + (corner >> 2U))) + axis];
    if (vertex == none) {
      const double a = grid_.values[from];
      const double b = grid_.values[vertex_index(corner | 1U << axis)];
      Vec3 place{static_cast<double>(i) + (corner & 1U),
                 static_cast<double>(j) + (corner >> 1U & 1U),
                 static_cast<double>(k) + (corner >> 2U)};
      place[static_cast<int>(axis)] += std::clamp(a / (a - b), clearance, 1 - clearance);
      vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(grid_.origin_body + grid_.spacing * place);
    }
    return vertex;
  }

  /// Fills a loop with triangles. A quad is split along a diagonal whose ends share no face of the
  /// cell: the neighbour behind a shared face might draw the same line, and four triangles would
  /// meet there. Longer loops get a vertex in their middle.
  void fill(const std::vector<std::size_t>& loop, std::int32_t i, std::int32_t j, std::int32_t k) {
    std::array<std::uint32_t, 12> v{};
    const std::size_t n = loop.size();
    for (std::size_t s = 0; s < n; ++s) v[s] = vertex_on(loop[s], i, j, k);
    if (n == 3) {
      mesh_.triangles.push_back({v[0], v[1], v[2]});
      return;
    }
    const auto may_split = [&](std::size_t s) {
      return n == 4 && (edge_faces[loop[s]] & edge_faces[loop[s + 2]]) == 0;
    };
    if (may_split(0)) {
      mesh_.triangles.push_back({v[0], v[1], v[2]});
      mesh_.triangles.push_back({v[0], v[2], v[3]});
    } else if (may_split(1)) {
      mesh_.triangles.push_back({v[1], v[2], v[3]});
      mesh_.triangles.push_back({v[1], v[3], v[0]});
    } else {
      Vec3 middle;
      for (std::size_t s = 0; s < n; ++s) middle += mesh_.vertices[v[s]];
      const auto center = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(middle / static_cast<double>(n));
      for (std::size_t s = 0; s < n; ++s) {
        mesh_.triangles.push_back({center, v[s], v[(s + 1) % n]});
      }
    }
  }

  LevelSetView grid_;
  std::size_t row_;
  std::size_t slab_;
  std::size_t base_{0};  // lowest vertex of the current cell
  // Of the lower and the upper layer: 3 * grid vertex in its layer + axis -> mesh vertex.
  std::array<std::vector<std::uint32_t>, 2> edge_vertex_;
  std::vector<std::size_t> loop_;
  TriangleMesh mesh_;
};

bool reaches_boundary(const LevelSetView& grid) {
  std::size_t v = 0;
  for (std::int32_t k = 0; k < grid.dims[2]; ++k) {
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      for (std::int32_t i = 0; i < grid.dims[0]; ++i, ++v) {
        const bool outermost = i == 0 || j == 0 || k == 0 || i + 1 == grid.dims[0] ||
                               j + 1 == grid.dims[1] || k + 1 == grid.dims[2];
        if (outermost && grid.values[v] < 0) return true;
      }
    }
  }
  return false;
}

}  // namespace

TriangleMesh extract_surface(const LevelSetView& grid) {
  if (reaches_boundary(grid)) {
    throw Error{{.place = "level set",
                 .problem = "the surface is open",
                 .reason = "the grain reaches the edge of its grid",
                 .fix = "Pad the grid by two vertices on each side."}};
  }
  return Extractor{grid}.run();
}

}  // namespace reckon
