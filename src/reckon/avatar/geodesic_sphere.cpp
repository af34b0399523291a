// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/geodesic_sphere.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "reckon/core/error.hpp"

namespace reckon {
namespace {

TriangleMesh icosahedron() {
  constexpr double g = std::numbers::phi;
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}},
          {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
           {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
           {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

TriangleMesh octahedron() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

/// Divides the faces of a base mesh; points on a base edge are made once and shared.
class Divider {
 public:
  Divider(const TriangleMesh& base, std::uint32_t n) : n_{n} {
    result_.vertices = base.vertices;
    for (const TriangleMesh::Triangle& face : base.triangles) divide(face);
    for (Vec3& v : result_.vertices) v = normalized(v);
  }
  [[nodiscard]] TriangleMesh take() { return std::move(result_); }

 private:
  std::uint32_t add(const Vec3& point) {
    result_.vertices.push_back(point);
    return static_cast<std::uint32_t>(result_.vertices.size() - 1);
  }

  /// Vertex number `step` of n on the way from one base vertex to another.
  std::uint32_t on_edge(std::uint32_t from, std::uint32_t to, std::uint32_t step) {
    if (step == 0) return from;
    if (step == n_) return to;
    if (from > to) return on_edge(to, from, n_ - step);
    const auto [found, is_new] = edges_.try_emplace({from, to}, 0);
    if (is_new) {
      found->second = static_cast<std::uint32_t>(result_.vertices.size());
      for (std::uint32_t s = 1; s < n_; ++s) {
        const Vec3& a = result_.vertices[from];
        const Vec3& b = result_.vertices[to];
        add((n_ - s) * a + s * b);
      }
    }
    return found->second + step - 1;
  }

  void divide(const TriangleMesh::Triangle& face) {
    const auto [a, b, c] = face;
    std::vector<std::uint32_t> lower;
    for (std::uint32_t i = 0; i <= n_; ++i) lower.push_back(on_edge(a, b, i));
    for (std::uint32_t j = 1; j <= n_; ++j) {  // rows parallel to a-b, shorter towards c
      std::vector<std::uint32_t> upper;
      for (std::uint32_t i = 0; i <= n_ - j; ++i) {
        if (i == 0) {
          upper.push_back(on_edge(a, c, j));
        } else if (i == n_ - j) {
          upper.push_back(on_edge(b, c, j));
        } else {
          const Vec3 point = (n_ - i - j) * result_.vertices[a] + i * result_.vertices[b] +
                             j * result_.vertices[c];
          upper.push_back(add(point));
        }
      }
      for (std::size_t i = 0; i + 1 < lower.size(); ++i) {
        result_.triangles.push_back({lower[i], lower[i + 1], upper[i]});
        if (i + 1 < upper.size()) {
          result_.triangles.push_back({lower[i + 1], upper[i + 1], upper[i]});
        }
      }
      lower = std::move(upper);
    }
  }

  std::uint32_t n_;
  TriangleMesh result_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges_;
};

}  // namespace

TriangleMesh geodesic_sphere(std::uint32_t n, GeodesicBase base) {
  if (n < 1 || n > highest_frequency) {
    throw Error{{.place = "geodesic sphere",
                 .problem = "cannot be divided " + std::to_string(n) + " times",
                 .reason = "the division must be 1 to " + std::to_string(highest_frequency),
                 .fix = "Choose another resolution."}};
  }
  return Divider{base == GeodesicBase::icosahedron ? icosahedron() : octahedron(), n}.take();
}

std::uint32_t geodesic_frequency(double radius, double target_edge, GeodesicBase base) {
  const double faces = base == GeodesicBase::icosahedron ? 20 : 8;
  // The edge of an equilateral triangle whose area is the mean one, 4 pi r^2 / (faces n^2).
  const double edge_once = radius * std::sqrt(16 * std::numbers::pi / std::numbers::sqrt3 / faces);
  const double n = std::ceil(edge_once / target_edge);
  if (!(radius > 0) || !(target_edge > 0) || !(n <= highest_frequency)) {
    throw Error{{.place = "surface mesh",
                 .problem = "an edge length of " + std::to_string(target_edge) +
                            " m does not suit a radius of " + std::to_string(radius) + " m",
                 .reason = "both must be positive, and at most " +
                           std::to_string(highest_frequency) + " edges fit along a base face",
                 .fix = "Choose a longer edge."}};
  }
  return n < 1 ? 1 : static_cast<std::uint32_t>(n);
}

}  // namespace reckon
