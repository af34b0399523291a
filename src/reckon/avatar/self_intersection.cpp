// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/self_intersection.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "reckon/avatar/predicates.hpp"
#include "reckon/avatar/triangle_bvh.hpp"

namespace reckon {
namespace {

using Corners = std::array<Vec3, 3>;

/// An axis along which a triangle with an area does not look like a line.
int viewing_axis(const Corners& t) {
  int axis = 0;
  while (axis < 2 && turn(t[0], t[1], t[2], axis) == 0) ++axis;
  return axis;
}

bool opposite(int a, int b) { return a * b < 0; }

/// All points lie in one plane, which is seen along `axis`.
bool coplanar_point_in_triangle(const Vec3& p, const Corners& t, int axis) {
  const int ab = turn(t[0], t[1], p, axis);
  const int bc = turn(t[1], t[2], p, axis);
  const int ca = turn(t[2], t[0], p, axis);
  return !opposite(ab, bc) && !opposite(bc, ca) && !opposite(ca, ab);
}

bool coplanar_segments_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, int axis) {
  const int pa = turn(p, q, a, axis);
  const int pb = turn(p, q, b, axis);
  const int ap = turn(a, b, p, axis);
  const int aq = turn(a, b, q, axis);
  if (pa == 0 && pb == 0) {  // on one line: they meet where their boxes do
    BoundingBox pq;
    pq.include(p);
    pq.include(q);
    BoundingBox ab;
    ab.include(a);
    ab.include(b);
    return pq.overlaps(ab);
  }
  return pa * pb <= 0 && ap * aq <= 0;
}

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Corners& t) {
  const int side_p = orientation(t[0], t[1], t[2], p);
  const int side_q = orientation(t[0], t[1], t[2], q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) {
    const int axis = viewing_axis(t);
    return coplanar_point_in_triangle(p, t, axis) ||
           coplanar_segments_meet(p, q, t[0], t[1], axis) ||
           coplanar_segments_meet(p, q, t[1], t[2], axis) ||
           coplanar_segments_meet(p, q, t[2], t[0], axis);
  }
  const int ab = orientation(p, q, t[0], t[1]);
  const int bc = orientation(p, q, t[1], t[2]);
  const int ca = orientation(p, q, t[2], t[0]);
  return !opposite(ab, bc) && !opposite(bc, ca) && !opposite(ca, ab);
}

bool any_side_meets(const Corners& sides, const Corners& t) {
  return segment_meets_triangle(sides[0], sides[1], t) ||
         segment_meets_triangle(sides[1], sides[2], t) ||
         segment_meets_triangle(sides[2], sides[0], t);
}

/// Two triangles over one edge overlap only when one is folded flat onto the other.
bool folded(const Vec3& from, const Vec3& to, const Vec3& tip, const Vec3& other_tip) {
  if (orientation(from, to, tip, other_tip) != 0) return false;
  const int axis = viewing_axis({from, to, tip});
  return turn(from, to, tip, axis) == turn(from, to, other_tip, axis);
}

/// The corners of `t` with those that `other` shares in front; counts the shared ones.
std::pair<Corners, int> shared_first(const TriangleMesh& mesh, const TriangleMesh::Triangle& t,
                                     const TriangleMesh::Triangle& other) {
  TriangleMesh::Triangle sorted = t;
  const auto is_shared = [&](std::uint32_t v) {
    return std::find(other.begin(), other.end(), v) != other.end();
  };
  // By index among the shared, so that both triangles name a shared edge in the same direction.
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
    return is_shared(a) != is_shared(b) ? is_shared(a) : a < b;
  });
  const auto count = static_cast<int>(std::count_if(t.begin(), t.end(), is_shared));
  return {{mesh.vertices[sorted[0]], mesh.vertices[sorted[1]], mesh.vertices[sorted[2]]}, count};
}

}  // namespace

bool triangles_meet(const TriangleMesh& mesh, std::uint32_t first, std::uint32_t second) {
  const TriangleMesh::Triangle& one = mesh.triangles[first];
  const TriangleMesh::Triangle& two = mesh.triangles[second];
  const auto [a, shared] = shared_first(mesh, one, two);
  const Corners b = shared_first(mesh, two, one).first;
  switch (shared) {
    case 0:
      return any_side_meets(a, b) || any_side_meets(b, a);
    case 1:  // beyond the shared corner, one side opposite to it must reach the other triangle
      return segment_meets_triangle(a[1], a[2], b) || segment_meets_triangle(b[1], b[2], a);
    case 2:
      return folded(a[0], a[1], a[2], b[2]);
    default:
      return true;
  }
}

std::optional<std::pair<std::uint32_t, std::uint32_t>> first_self_intersection(
    const TriangleMesh& mesh) {
  const TriangleBvh bvh{mesh};
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    BoundingBox box;
    for (const std::uint32_t v : mesh.triangles[t]) box.include(mesh.vertices[v]);
    std::uint32_t lowest = std::numeric_limits<std::uint32_t>::max();
    bvh.for_each_overlap(box, [&](std::uint32_t other) {
      if (other > t && other < lowest && triangles_meet(mesh, t, other)) lowest = other;
    });
    if (lowest != std::numeric_limits<std::uint32_t>::max()) return std::pair{t, lowest};
  }
  return std::nullopt;
}

}  // namespace reckon
