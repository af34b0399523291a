// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/triangle_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "reckon/avatar/half_edges.hpp"
#include "reckon/core/error.hpp"

namespace reckon {
namespace {

constexpr std::uint32_t triangles_per_leaf = 4;

void require_usable(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) {
    throw Error{{.place = "surface mesh",
                 .problem = "has no triangles",
                 .reason = "",
                 .fix = "Give a closed surface."}};
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!is_finite(mesh.vertices[v])) {
      throw Error{{.place = "surface mesh",
                   .problem = "vertex " + std::to_string(v) + " is not finite",
                   .reason = "",
                   .fix = "Check what wrote the mesh."}};
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (v < mesh.vertices.size()) continue;
      throw Error{{.place = "surface mesh",
                   .problem = "triangle " + std::to_string(t) + " uses vertex " +
                              std::to_string(v) + ", which does not exist",
                   .reason = "the mesh has " + std::to_string(mesh.vertices.size()) + " vertices",
                   .fix = "Check what wrote the mesh."}};
    }
  }
}

/// The closest point of side `side` of a triangle, which runs from `a` to `b`.
ClosestPoint closest_on_side(const Vec3& point, const Vec3& a, const Vec3& b, std::uint8_t side) {
  const Vec3 along = b - a;
  const double squared_length = squared_norm(along);
  const double t = squared_length > 0 ? dot(point - a, along) / squared_length : 0;
  ClosestPoint closest;
  if (t <= 0) {
    closest.point = a;
    closest.feature = TriangleFeature::vertex;
    closest.side = side;
  } else if (t >= 1) {
    closest.point = b;
    closest.feature = TriangleFeature::vertex;
    closest.side = static_cast<std::uint8_t>((side + 1) % 3);
  } else {
    closest.point = a + t * along;
    closest.feature = TriangleFeature::edge;
    closest.side = side;
  }
  closest.squared_distance = squared_norm(point - closest.point);
  return closest;
}

/// The angle between two directions [rad]; 0 when one of them has no length. Written with the
/// tangent, which stays accurate for small and for flat angles.
double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

/// The low 21 bits of a number, two zeros after each.
std::uint64_t spaced_out(std::uint64_t bits) {
  bits = (bits | bits << 32U) & 0x001f00000000ffffU;
  bits = (bits | bits << 16U) & 0x001f0000ff0000ffU;
  bits = (bits | bits << 8U) & 0x100f00f00f00f00fU;
  bits = (bits | bits << 4U) & 0x10c30c30c30c30c3U;
  return (bits | bits << 2U) & 0x1249249249249249U;
}

/// The place of a point of a box along Morton's curve.
std::uint64_t curve_place(const Vec3& point, const BoundingBox& box) {
  constexpr double cells = 2097151;  // 2^21 - 1
  std::uint64_t place = 0;
  for (int axis = 0; axis < 3; ++axis) {
    // Halves, because the whole may be too large for a double.
    const double extent = 0.5 * box.high[axis] - 0.5 * box.low[axis];
    const double part = extent > 0 ? (0.5 * point[axis] - 0.5 * box.low[axis]) / extent : 0;
    place |= spaced_out(static_cast<std::uint64_t>(cells * std::clamp(part, 0.0, 1.0)))
             << static_cast<unsigned>(axis);
  }
  return place;
}

}  // namespace

void BoundingBox::include(const Vec3& point) {
  low = {std::min(low.x, point.x), std::min(low.y, point.y), std::min(low.z, point.z)};
  high = {std::max(high.x, point.x), std::max(high.y, point.y), std::max(high.z, point.z)};
}

void BoundingBox::include(const BoundingBox& other) {
  include(other.low);
  include(other.high);
}

double BoundingBox::squared_distance(const Vec3& point) const {
  const double dx = std::max({low.x - point.x, 0.0, point.x - high.x});
  const double dy = std::max({low.y - point.y, 0.0, point.y - high.y});
  const double dz = std::max({low.z - point.z, 0.0, point.z - high.z});
  return dx * dx + dy * dy + dz * dz;
}

BoundingBox bounding_box(const TriangleMesh& mesh) {
  BoundingBox box;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) box.include(mesh.vertices[v]);
  }
  return box;
}

ClosestPoint closest_point_on_triangle(const Vec3& point, const Vec3& a, const Vec3& b,
                                       const Vec3& c) {
  constexpr double slender = 1e-12;  // squared sine of an angle whose places round badly
  constexpr double near_side = 1e-3;
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 normal = cross(ab, ac);
  const double scale = squared_norm(normal);
  std::array<bool, 3> beyond{true, true, true};  // which sides may be closest
  if (scale > 0) {
    const Vec3 ap = point - a;
    const double v = dot(cross(ap, ac), normal) / scale;
    const double w = dot(cross(ab, ap), normal) / scale;
    if (v > 0 && w > 0 && v + w < 1) {
      ClosestPoint closest;
      closest.point = a + v * ab + w * ac;
      closest.squared_distance = squared_norm(point - closest.point);
      return closest;
    }
    if (scale > slender * squared_norm(ab) * squared_norm(ac)) {
      beyond = {!(w > near_side), !(1 - v - w > near_side), !(v > near_side)};
    }
  }
  // The projection falls outside, so the closest point is on a side that it lies beyond.
  const std::array<const Vec3*, 4> rim{&a, &b, &c, &a};
  ClosestPoint best;
  for (std::uint8_t side = 0; side < 3; ++side) {
    if (!beyond[side]) continue;
    const ClosestPoint found = closest_on_side(point, *rim[side], *rim[side + 1U], side);
    if (found.squared_distance < best.squared_distance) best = found;
  }
  return best;
}

TriangleBvh::TriangleBvh(const TriangleMesh& mesh) : triangles_{mesh.triangles} {
  require_usable(mesh);
  build_tree(mesh);
  build_pseudo_normals(mesh);
}

void TriangleBvh::build_tree(const TriangleMesh& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<Vec3> centers(count);
  BoundingBox spread;
  for (std::uint32_t t = 0; t < count; ++t) {
    const TriangleMesh::Triangle& corners = mesh.triangles[t];
    centers[t] = mesh.vertices[corners[0]] / 3 + mesh.vertices[corners[1]] / 3 +
                 mesh.vertices[corners[2]] / 3;
    spread.include(centers[t]);
  }
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(count);
  for (std::uint32_t t = 0; t < count; ++t) keyed[t] = {curve_place(centers[t], spread), t};
  std::sort(keyed.begin(), keyed.end());

  // A node is created as a leaf over a range of the curve and halved until the range is small.
  nodes_.push_back({{}, 0, count});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::uint32_t first = nodes_[n].first;
    const std::uint32_t size = nodes_[n].count;
    if (size <= triangles_per_leaf) continue;
    const std::uint32_t half = size / 2;
    nodes_[n].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[n].count = 0;
    nodes_.push_back({{}, first, half});
    nodes_.push_back({{}, first + half, size - half});
  }

  leaves_.reserve(count);
  for (const auto& [place, t] : keyed) {
    const TriangleMesh::Triangle& corners = mesh.triangles[t];
    leaves_.push_back(
        {{mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]}, t});
  }
  // Children come after their parents.
  for (std::size_t last = nodes_.size(); last > 0; --last) {
    Node& node = nodes_[last - 1];
    if (node.count == 0) {
      node.box.include(nodes_[node.first].box);
      node.box.include(nodes_[node.first + 1].box);
    }
    for (std::uint32_t n = node.first; n < node.first + node.count; ++n) {
      for (const Vec3& corner : leaves_[n].corners) node.box.include(corner);
    }
  }
}

void TriangleBvh::build_pseudo_normals(const TriangleMesh& mesh) {
  face_normals_.resize(mesh.triangles.size());
  edge_normals_.resize(3 * mesh.triangles.size());
  vertex_normals_.resize(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const TriangleMesh::Triangle& corners = mesh.triangles[t];
    const std::array<Vec3, 3> at{mesh.vertices[corners[0]], mesh.vertices[corners[1]],
                                 mesh.vertices[corners[2]]};
    face_normals_[t] = normalized(doubled_area_vector(mesh, corners));
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 next = at[(c + 1) % 3] - at[c];
      const Vec3 previous = at[(c + 2) % 3] - at[c];
      vertex_normals_[corners[c]] += angle_between(next, previous) * face_normals_[t];
    }
  }
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
  for (std::size_t first = 0; first < edges.size();) {
    Vec3 sum;
    std::size_t last = first;
    for (; last < edges.size() && edges[last].same_edge(edges[first]); ++last) {
      sum += face_normals_[edges[last].triangle];
    }
    for (; first < last; ++first) {
      edge_normals_[3 * std::size_t{edges[first].triangle} + edges[first].side] = sum;
    }
  }
}

void TriangleBvh::search(const Vec3& point, ClosestPoint& best) const {
  struct Entry {
    double squared_distance;
    std::uint32_t node;
  };
  std::array<Entry, max_depth> stack{};
  stack[0] = {nodes_.front().box.squared_distance(point), 0};
  std::size_t size = 1;
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.squared_distance <= best.squared_distance)) continue;
    const Node& node = nodes_[entry.node];
    if (node.count == 0) {
      Entry near{nodes_[node.first].box.squared_distance(point), node.first};
      Entry far{nodes_[node.first + 1].box.squared_distance(point), node.first + 1};
      if (far.squared_distance < near.squared_distance) std::swap(near, far);
      stack[size++] = far;
      stack[size++] = near;
      continue;
    }
    for (std::uint32_t n = node.first; n < node.first + node.count; ++n) {
      const Leaf& leaf = leaves_[n];
      ClosestPoint found =
          closest_point_on_triangle(point, leaf.corners[0], leaf.corners[1], leaf.corners[2]);
      // Among triangles at equal distance the lowest is taken, independent of the tree.
      if (found.squared_distance < best.squared_distance ||
          (found.squared_distance == best.squared_distance && leaf.triangle < best.triangle)) {
        found.triangle = leaf.triangle;
        best = found;
      }
    }
  }
}

ClosestPoint TriangleBvh::closest_point(const Vec3& point) const {
  ClosestPoint best;
  search(point, best);
  return best;
}

std::optional<ClosestPoint> TriangleBvh::closest_point_within(const Vec3& point,
                                                              double radius) const {
  ClosestPoint best;
  best.squared_distance = radius * radius;
  best.triangle = std::numeric_limits<std::uint32_t>::max();
  search(point, best);
  if (best.triangle == std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return best;
}

std::vector<std::uint32_t> TriangleBvh::tree_order() const {
  std::vector<std::uint32_t> order;
  order.reserve(leaves_.size());
  for (const Leaf& leaf : leaves_) order.push_back(leaf.triangle);
  return order;
}

Vec3 TriangleBvh::pseudo_normal(const ClosestPoint& closest) const {
  switch (closest.feature) {
    case TriangleFeature::edge:
      return edge_normals_[3 * std::size_t{closest.triangle} + closest.side];
    case TriangleFeature::vertex:
      return vertex_normals_[triangles_[closest.triangle][closest.side]];
    case TriangleFeature::face:
      break;
  }
  return face_normals_[closest.triangle];
}

double TriangleBvh::signed_distance(const Vec3& point, const ClosestPoint& closest) const {
  const double distance = std::sqrt(closest.squared_distance);
  return dot(pseudo_normal(closest), point - closest.point) < 0 ? -distance : distance;
}

double TriangleBvh::signed_distance(const Vec3& point) const {
  return signed_distance(point, closest_point(point));
}

}  // namespace reckon
