// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/closest_triangles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "reckon/avatar/triangle_bvh.hpp"

// Whoever has its closest point on a triangle lies above or below it, or beside it by little: the
// direction from a closest point is in the cone of the normals around it. Let all triangles at a
// triangle's corners have normals within an angle phi of its own. Near a corner the surface is then
// the graph of a function over the triangle's plane, with slopes up to tan phi. The direction
// (u, w) from a closest point there, u along the plane, has u.x + w g(x) <= 0 for all steps x and
// rises g(x); x = u gives |u| <= |w| tan phi. So a point at a distance r with its closest point on
// the triangle is not farther beside it than r sin phi, nor than tan phi times its height.

namespace reckon {
namespace {

// What only rules out triangles is computed in single precision, with a margin above its rounding
// on grids of some 10^3 vertices a row.
constexpr float margin = 1e-2F;        // [spacings]
constexpr double widest_cosine = 0.2;  // of cones; wider ones exclude nothing

using Lanes [[gnu::vector_size(16)]] = float;

/// Four heights above planes as functions of a place on the grid [spacings], a lane each: above a
/// triangle, and outwards across its sides.
struct Heights {
  Lanes x, y, z;    // gradients
  Lanes start;      // at the grid's vertex (0, 0, 0)
  Lanes inverse_x;  // finite

  Heights(const std::array<Vec3, 4>& normals, const std::array<Vec3, 4>& zeros) {
    constexpr float least = 1e-5F;
    for (std::size_t n = 0; n < 4; ++n) {
      const auto slope = static_cast<float>(normals[n].x);
      x[n] = std::abs(slope) < least ? std::copysign(least, slope) : slope;
      y[n] = static_cast<float>(normals[n].y);
      z[n] = static_cast<float>(normals[n].z);
      start[n] = static_cast<float>(-dot(normals[n], zeros[n]));
    }
    inverse_x = 1 / x;
  }
};

/// The grid's vertices along an axis from a place to another.
struct Span {
  std::int32_t first;
  std::int32_t last;

  Span(float low, float high, std::int32_t vertices)
      : first{low > 0 ? static_cast<std::int32_t>(low) + 1 : 0},
        last{high < 0 ? -1 : std::min(static_cast<std::int32_t>(high), vertices - 1)} {}
};

class Search {
 public:
  Search(const TriangleMesh& mesh, const LevelSet& grid, double reach)
      : mesh_{mesh}, grid_{grid}, reach_{static_cast<float>(reach / grid.spacing) + margin} {
    squared_.assign(grid_.index(0, 0, grid_.dims[2]), reach * reach);
    triangle_.assign(squared_.size(), no_triangle);
    measure_cones();
  }

  std::vector<std::uint32_t> run() {
    // In the order of their numbers, so that of equally close triangles the first wins, as in
    // TriangleBvh.
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) offer(t);
    return std::move(triangle_);
  }

 private:
  /// An axis and the cosine of the largest angle to it of the normals around a mesh vertex.
  struct Cone {
    Vec3 axis;
    double cosine{1};
  };

  void measure_cones() {
    normal_.reserve(mesh_.triangles.size());
    cone_.resize(mesh_.vertices.size());
    for (const TriangleMesh::Triangle& t : mesh_.triangles) {
      normal_.push_back(normalized(doubled_area_vector(mesh_, t)));
      for (const std::uint32_t corner : t) cone_[corner].axis += normal_.back();
    }
    for (Cone& cone : cone_) cone.axis = normalized(cone.axis);
    for (std::size_t t = 0; t < normal_.size(); ++t) {
      for (const std::uint32_t corner : mesh_.triangles[t]) {
        Cone& cone = cone_[corner];
        cone.cosine = std::min(cone.cosine, dot(cone.axis, normal_[t]));
      }
    }
  }

  /// The cosine of an angle to a triangle's normal that no normal around its corners exceeds.
  [[nodiscard]] double cone_cosine(std::uint32_t t) const {
    const auto sine = [](double cosine) { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); };
    double least = 1;
    for (const std::uint32_t corner : mesh_.triangles[t]) {
      const Cone& cone = cone_[corner];
      const double own = dot(cone.axis, normal_[t]);
      if (!(own > 0 && cone.cosine > 0)) return 0;
      least = std::min(least, own * cone.cosine - sine(own) * sine(cone.cosine));
    }
    return least;
  }

  [[nodiscard]] Vec3 in_spacings(const Vec3& point) const {
    return (point - grid_.origin_body) / grid_.spacing;
  }

  /// Offers a triangle to all vertices that may be closest to it.
  void offer(std::uint32_t t) {
    const TriangleMesh::Triangle& triangle = mesh_.triangles[t];
    const std::array<Vec3, 3> corners{mesh_.vertices[triangle[0]], mesh_.vertices[triangle[1]],
                                      mesh_.vertices[triangle[2]]};
    const Vec3 a = in_spacings(corners[0]);
    const Vec3 b = in_spacings(corners[1]);
    const Vec3 c = in_spacings(corners[2]);
    const Vec3& normal = normal_[t];
    const Heights heights{{normal, normalized(cross(b - a, normal)),
                           normalized(cross(c - b, normal)), normalized(cross(a - c, normal))},
                          {a, a, b, c}};
    const double cosine = cone_cosine(t);
    const bool tells = cosine > widest_cosine;
    const auto sine = static_cast<float>(std::sqrt(std::max(0.0, 1 - cosine * cosine)));
    const float beside = margin + (tells ? reach_ * sine : reach_);
    const float tangent = tells ? sine / static_cast<float>(cosine) : 1e6F;

    const auto low = [&](int axis) {
      return static_cast<float>(std::min({a[axis], b[axis], c[axis]}) -
                                double{reach_} * std::abs(normal[axis]) - double{beside});
    };
    const auto high = [&](int axis) {
      return static_cast<float>(std::max({a[axis], b[axis], c[axis]}) +
                                double{reach_} * std::abs(normal[axis]) + double{beside});
    };
    const Span js{low(1), high(1), grid_.dims[1]};
    const Span ks{low(2), high(2), grid_.dims[2]};
    const float low_x = low(0);
    const float high_x = high(0);
    const Lanes limits{reach_, beside, beside, beside};
    const Lanes unbound{1e9F, 1e9F, 1e9F, 1e9F};
    const float to_other_side = std::abs(2 * reach_ * heights.inverse_x[0]);
    for (std::int32_t k = ks.first; k <= ks.last; ++k) {
      for (std::int32_t j = js.first; j <= js.last; ++j) {
        const Lanes at =
            heights.start + static_cast<float>(j) * heights.y + static_cast<float>(k) * heights.z;
        // Where along the row heights are at their limits; and what comes before or after.
        const Lanes ends = (limits - at) * heights.inverse_x;
        Lanes lows = heights.x < 0 ? ends : -unbound;
        Lanes highs = heights.x > 0 ? ends : unbound;
        lows[0] = heights.x[0] < 0 ? ends[0] : ends[0] - to_other_side;
        highs[0] = heights.x[0] > 0 ? ends[0] : ends[0] + to_other_side;
        const Span is{std::max({low_x, lows[0], lows[1], lows[2], lows[3]}),
                      std::min({high_x, highs[0], highs[1], highs[2], highs[3]}), grid_.dims[0]};
        for (std::int32_t i = is.first; i <= is.last; ++i) {
          const Lanes here = at + static_cast<float>(i) * heights.x;
          const float h = std::abs(here[0]);
          const float e = std::max(std::max(here[1], here[2]), std::max(here[3], 0.0F));
          if (e > h * tangent + margin || h * h + e * e > reach_ * reach_) continue;
          try_vertex(i, j, k, t, corners);
        }
      }
    }
  }

  void try_vertex(std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t t,
                  const std::array<Vec3, 3>& corners) {
    const double squared =
        closest_point_on_triangle(grid_.vertex_body(i, j, k), corners[0], corners[1], corners[2])
            .squared_distance;
    const std::size_t v = grid_.index(i, j, k);
    if (!(squared < squared_[v])) return;
    squared_[v] = squared;
    triangle_[v] = t;
  }

  const TriangleMesh& mesh_;
  const LevelSet& grid_;
  float reach_;  // [spacings]
  std::vector<Vec3> normal_;
  std::vector<Cone> cone_;
  std::vector<double> squared_;  // distance of the closest triangle yet [m^2]
  std::vector<std::uint32_t> triangle_;
};

}  // namespace

std::vector<std::uint32_t> closest_triangles(const TriangleMesh& mesh, const LevelSet& grid,
                                             double reach) {
  return Search{mesh, grid, reach}.run();
}

}  // namespace reckon
