// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// Points on a surface with the outward normals there.
struct OrientedPoints {
  std::vector<Vec3> position;  ///< [m]
  std::vector<Vec3> normal;    ///< unit vectors

  [[nodiscard]] std::size_t size() const { return position.size(); }
};

/// Points that each represent an equal share of a surface: the triangles are lined up such that
/// neighbours in the line are neighbours on the surface, the line is cut into equal areas, and the
/// place inside a triangle comes from the additive recurrence of Roberts' R2 sequence. No chance is
/// involved. Keeps references.
class SurfaceSampler {
 public:
  /// `order`: all triangles in such a line, e.g. TriangleBvh::tree_order().
  SurfaceSampler(const TriangleMesh& mesh, std::span<const std::uint32_t> order);

  [[nodiscard]] double area() const { return area_; }

  /// Calls visit(position, outward normal) for `count` points along the line.
  template <class Visit>
  void for_each(std::size_t count, Visit&& visit) const;

 private:
  const TriangleMesh& mesh_;
  std::span<const std::uint32_t> order_;
  double area_{0};
};

/// All of them, in any order.
[[nodiscard]] OrientedPoints sample_surface(const TriangleMesh& mesh, std::size_t count);
[[nodiscard]] OrientedPoints sample_surface(const SurfaceSampler& sampler, std::size_t count);

/// `count` points spread evenly on a surface: Lloyd's relaxation (each point moves to the middle of
/// the samples that are nearest to it) from evenly spaced samples, and at last onto the surface.
/// The first of them are `fixed`: they stay where they are and push the others away.
[[nodiscard]] OrientedPoints spread_points(const SurfaceSampler& sampler, const TriangleBvh& bvh,
                                           std::size_t count, const OrientedPoints& fixed = {});

/// Each point's share of a surface: the part of `samples` that is nearest to it, times `area`.
/// A sample never counts for a point whose normal is turned away from its own by more than 120
/// degrees: on a thin plate, that is a point of the other side. Sums to `area` (up to rounding).
[[nodiscard]] std::vector<double> tributary_areas(const OrientedPoints& points,
                                                  const OrientedPoints& samples, double area);
/// With `count` samples, which are not kept. The areas sum to the surface's, but for those of the
/// first `on_edges` points: such a point has a share of every face that meets at its edge, and in
/// contact it stands for the face that is met. It gets the mean of those shares, so that the areas
/// of a face's nodes, edges included, sum to the face's: exactly so over all faces.
[[nodiscard]] std::vector<double> tributary_areas(const OrientedPoints& points,
                                                  const SurfaceSampler& sampler, std::size_t count,
                                                  std::size_t on_edges = 0);

template <class Visit>
void SurfaceSampler::for_each(std::size_t count, Visit&& visit) const {
  // The plastic number's powers: x^3 = x + 1.
  constexpr double plastic = 1.32471795724474602596;
  constexpr double step_u = 1 / plastic;
  constexpr double step_v = 1 / (plastic * plastic);
  const double share = area_ / static_cast<double>(count);
  double area_before = 0;
  std::size_t k = 0;
  for (std::size_t o = 0; o < order_.size(); ++o) {
    const TriangleMesh::Triangle& t = mesh_.triangles[order_[o]];
    const Vec3& a = mesh_.vertices[t[0]];
    const Vec3 to_b = mesh_.vertices[t[1]] - a;
    const Vec3 to_c = mesh_.vertices[t[2]] - a;
    const Vec3 doubled = cross(to_b, to_c);
    area_before += 0.5 * norm(doubled);
    const bool last = o + 1 == order_.size();
    if (!last && !((static_cast<double>(k) + 0.5) * share < area_before)) continue;
    const Vec3 normal = normalized(doubled);
    for (; k < count && (last || (static_cast<double>(k) + 0.5) * share < area_before); ++k) {
      const double index = static_cast<double>(k) + 1;
      double u = index * step_u - std::floor(index * step_u);
      double v = index * step_v - std::floor(index * step_v);
      if (u + v > 1) {  // folding keeps the sequence's evenness, which a root would bend
        u = 1 - u;
        v = 1 - v;
      }
      visit(a + u * to_b + v * to_c, normal);
    }
  }
}

}  // namespace reckon
