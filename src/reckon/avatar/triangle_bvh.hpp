// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// An axis-aligned box; empty until something is put in.
struct BoundingBox {
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 high{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity()};

  void include(const Vec3& point);
  void include(const BoundingBox& other);
  /// Touching boxes overlap.
  [[nodiscard]] bool overlaps(const BoundingBox& other) const {
    return low.x <= other.high.x && other.low.x <= high.x && low.y <= other.high.y &&
           other.low.y <= high.y && low.z <= other.high.z && other.low.z <= high.z;
  }
  /// Zero for a point inside.
  [[nodiscard]] double squared_distance(const Vec3& point) const;
};

[[nodiscard]] BoundingBox bounding_box(const TriangleMesh& mesh);

/// The part of a triangle that a closest point lies on.
enum class TriangleFeature : std::uint8_t { face, edge, vertex };

/// The point of a surface that is closest to a query point.
struct ClosestPoint {
  double squared_distance{std::numeric_limits<double>::infinity()};  ///< [m^2]
  Vec3 point;                                                        ///< on the surface [m]
  std::uint32_t triangle{0};  ///< a triangle that holds the point
  TriangleFeature feature{TriangleFeature::face};
  std::uint8_t side{0};  ///< edge: side s joins corners s and s + 1 mod 3; vertex: corner s
};

/// The point of the triangle (a, b, c) that is closest to `point`; `triangle` is left at 0.
/// Safe for triangles without area.
[[nodiscard]] ClosestPoint closest_point_on_triangle(const Vec3& point, const Vec3& a,
                                                     const Vec3& b, const Vec3& c);

/// A bounding volume hierarchy over the triangles of a mesh: a binary tree of boxes, which halves
/// the triangles as they lie along a space-filling curve. Holds copies of what it needs; the mesh
/// may go. All queries are const and may run in many threads at once; their answers do not depend
/// on earlier ones.
class TriangleBvh {
 public:
  /// Throws Error when the mesh has no triangle, an index out of range or a vertex that is not
  /// finite. Only signed_distance needs the mesh to be closed.
  explicit TriangleBvh(const TriangleMesh& mesh);

  [[nodiscard]] const BoundingBox& bounds() const { return nodes_.front().box; }

  /// The closest point of the surface. `point` must be finite.
  [[nodiscard]] ClosestPoint closest_point(const Vec3& point) const;

  /// The closest point of the surface if it lies within `radius`, else nothing. The smaller the
  /// radius, the faster; a found answer is the same as closest_point's.
  [[nodiscard]] std::optional<ClosestPoint> closest_point_within(const Vec3& point,
                                                                 double radius) const;

  /// The distance to a closed surface, negative inside [m]. The sign comes from angle-weighted
  /// pseudo-normals (Baerentzen & Aanaes 2005), which decide it rightly also where an edge or a
  /// vertex is closest.
  [[nodiscard]] double signed_distance(const Vec3& point) const;

  /// The same for a closest point that is known already.
  [[nodiscard]] double signed_distance(const Vec3& point, const ClosestPoint& closest) const;

  /// The surface's outward pseudo-normal where `closest` lies: the face's normal, the sum of both
  /// faces' normals at an edge, the sum weighted by corner angles at a vertex. Not normalised; zero
  /// on a face without area.
  [[nodiscard]] Vec3 pseudo_normal(const ClosestPoint& closest) const;

  /// All triangles, such that those near each other in the order are near each other in space.
  [[nodiscard]] std::vector<std::uint32_t> tree_order() const;

  /// Calls visit(triangle index) once for every triangle whose bounding box overlaps or touches
  /// `box`, in a fixed order.
  template <class Visit>
  void for_each_overlap(const BoundingBox& box, Visit&& visit) const {
    std::array<std::uint32_t, max_depth> stack{};
    std::size_t size = 1;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (!node.box.overlaps(box)) continue;
      if (node.count == 0) {
        stack[size++] = node.first + 1;
        stack[size++] = node.first;
        continue;
      }
      for (std::uint32_t n = node.first; n < node.first + node.count; ++n) {
        BoundingBox own;
        for (const Vec3& corner : leaves_[n].corners) own.include(corner);
        if (own.overlaps(box)) visit(leaves_[n].triangle);
      }
    }
  }

 private:
  // Halving 2^32 triangles takes 32 levels, and a traversal holds one sibling per level.
  static constexpr std::size_t max_depth = 64;

  struct Node {
    BoundingBox box;
    std::uint32_t first{0};  // leaf: first triangle in leaves_; else: the first of two children
    std::uint32_t count{0};  // leaf: number of triangles; else 0
  };
  struct Leaf {
    std::array<Vec3, 3> corners;
    std::uint32_t triangle{0};
  };

  void build_tree(const TriangleMesh& mesh);
  void build_pseudo_normals(const TriangleMesh& mesh);
  void search(const Vec3& point, ClosestPoint& best) const;

  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;  // in tree order
  std::vector<TriangleMesh::Triangle> triangles_;
  std::vector<Vec3> face_normals_;  // by triangle
  std::vector<Vec3> edge_normals_;  // three a triangle
  std::vector<Vec3> vertex_normals_;
};

}  // namespace reckon
