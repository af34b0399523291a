// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/triangle_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

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
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 normal = cross(ab, ac);
  const double scale = squared_norm(normal);
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
  }
  // The projection falls outside, so the closest point is on the rim.
  ClosestPoint best = closest_on_side(point, a, b, 0);
  const ClosestPoint second = closest_on_side(point, b, c, 1);
  if (second.squared_distance < best.squared_distance) best = second;
  const ClosestPoint third = closest_on_side(point, c, a, 2);
  if (third.squared_distance < best.squared_distance) best = third;
  return best;
}

TriangleBvh::TriangleBvh(const TriangleMesh& mesh) : triangles_{mesh.triangles} {
  require_usable(mesh);
  build_tree(mesh);
  build_pseudo_normals(mesh);
}

void TriangleBvh::build_tree(const TriangleMesh& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::vector<BoundingBox> boxes(count);
  std::vector<Vec3> centers(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) boxes[t].include(mesh.vertices[v]);
    centers[t] = 0.5 * boxes[t].low + 0.5 * boxes[t].high;
  }
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);

  // A node is created as a leaf over a range of `order` and split until the range is small. Nodes
  // are worked off in the order in which they were made, so the tree depends on the mesh alone.
  nodes_.push_back({{}, 0, count});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::uint32_t first = nodes_[n].first;
    const std::uint32_t size = nodes_[n].count;
    const auto begin = order.begin() + first;
    const auto end = begin + size;
    BoundingBox spread;
    for (auto t = begin; t != end; ++t) {
      nodes_[n].box.include(boxes[*t]);
      spread.include(centers[*t]);
    }
    if (size <= triangles_per_leaf) {
      std::sort(begin, end);
      continue;
    }
    const Vec3 extent = spread.high - spread.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const std::uint32_t half = size / 2;
    std::nth_element(begin, begin + half, end, [&](std::uint32_t a, std::uint32_t b) {
      return centers[a][axis] != centers[b][axis] ? centers[a][axis] < centers[b][axis] : a < b;
    });
    nodes_[n].first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[n].count = 0;
    nodes_.push_back({{}, first, half});
    nodes_.push_back({{}, first + half, size - half});
  }

  leaves_.reserve(count);
  for (const std::uint32_t t : order) {
    const TriangleMesh::Triangle& corners = mesh.triangles[t];
    leaves_.push_back(
        {{mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]}, t});
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
    face_normals_[t] = normalized(cross(at[1] - at[0], at[2] - at[0]));
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
      // Among triangles at equal distance the lowest wins, whatever the tree looks like.
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
