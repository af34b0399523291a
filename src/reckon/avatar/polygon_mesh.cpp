// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/polygon_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "reckon/avatar/predicates.hpp"
#include "reckon/core/error.hpp"

namespace reckon {
namespace {

// A corner that lies this little off the line between its neighbours, in parts of the face's size,
// is taken as lying on it while there are better ones: else rounding would make slivers of it.
constexpr double straight = 1e-6;
constexpr double no_area = 1e-12;  // of the face's size squared

/// One face, clipped ear by ear (Meisters 1975: a simple polygon has two ears).
class EarClipping {
 public:
  EarClipping(const std::vector<Vec3>& vertices, std::vector<std::uint32_t> face)
      : vertices_{vertices}, face_{std::move(face)} {
    // Newell's normal: twice the area of the outline's projections.
    Vec3 normal;
    const Vec3& origin = at(0);
    for (std::size_t c = 1; c + 1 < face_.size(); ++c) {
      normal += cross(at(c) - origin, at(c + 1) - origin);
    }
    for (int axis = 1; axis < 3; ++axis) {
      if (std::abs(normal[axis]) > std::abs(normal[axis_])) axis_ = axis;
    }
    side_ = normal[axis_] < 0 ? -1 : 1;
    double size = 0;
    for (std::size_t c = 1; c < face_.size(); ++c) size = std::max(size, norm(at(c) - origin));
    has_area_ = std::abs(normal[axis_]) > no_area * size * size;
    tolerance_ = straight * size;
  }

  /// False when the outline crosses itself.
  bool run(std::vector<TriangleMesh::Triangle>& triangles) {
    if (!has_area_) return fan(triangles);
    find_reflex();
    std::size_t corner = 1;
    std::size_t refused = 0;  // corners in a row that are no ears
    while (face_.size() > 3) {
      corner %= face_.size();
      if (!is_ear(corner)) {
        ++corner;
        if (++refused <= face_.size()) continue;
        if (tolerance_ == 0) return false;
        tolerance_ = 0;  // from now on exact
        refused = 0;
        find_reflex();
        continue;
      }
      refused = 0;
      triangles.push_back({face_[before(corner)], face_[corner], face_[after(corner)]});
      face_.erase(face_.begin() + static_cast<std::ptrdiff_t>(corner));
      find_reflex_near(corner);
    }
    tolerance_ = 0;
    if (turn_at(1) <= 0) return false;
    triangles.push_back({face_[0], face_[1], face_[2]});
    return true;
  }

 private:
  bool fan(std::vector<TriangleMesh::Triangle>& triangles) const {
    for (std::size_t c = 2; c < face_.size(); ++c) {
      triangles.push_back({face_[0], face_[c - 1], face_[c]});
    }
    return true;
  }

  [[nodiscard]] const Vec3& at(std::size_t corner) const { return vertices_[face_[corner]]; }
  [[nodiscard]] std::size_t before(std::size_t corner) const {
    return corner == 0 ? face_.size() - 1 : corner - 1;
  }
  [[nodiscard]] std::size_t after(std::size_t corner) const {
    return corner + 1 == face_.size() ? 0 : corner + 1;
  }
  /// 1 where a - b - c turns left as seen from the face's outer side; 0 on a line.
  [[nodiscard]] int turn_of(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const double longest =
        std::sqrt(std::max({squared_norm(ab), squared_norm(ac), squared_norm(c - b)}));
    const bool on_line = std::abs(cross(ab, ac)[axis_]) < tolerance_ * longest;
    return on_line ? 0 : side_ * turn(a, b, c, axis_);
  }
  [[nodiscard]] int turn_at(std::size_t corner) const {
    return turn_of(at(before(corner)), at(corner), at(after(corner)));
  }

  void find_reflex() {
    reflex_.clear();
    for (std::size_t c = 0; c < face_.size(); ++c) {
      if (turn_at(c) <= 0) reflex_.push_back(face_[c]);
    }
  }
  /// After a corner before `corner` was removed: its neighbours may have become convex.
  void find_reflex_near(std::size_t corner) {
    for (const std::size_t c : {before(corner % face_.size()), corner % face_.size()}) {
      if (turn_at(c) > 0) std::erase(reflex_, face_[c]);
    }
  }

  /// A convex corner whose triangle holds no other corner of the outline, not even on its border.
  /// If it held one, it would hold one that is not convex.
  [[nodiscard]] bool is_ear(std::size_t corner) const {
    if (turn_at(corner) <= 0) return false;
    const Vec3& a = at(before(corner));
    const Vec3& b = at(corner);
    const Vec3& c = at(after(corner));
    return std::none_of(reflex_.begin(), reflex_.end(), [&](std::uint32_t vertex) {
      const Vec3& p = vertices_[vertex];
      if (p == a || p == b || p == c) return false;
      return turn_of(a, b, p) >= 0 && turn_of(b, c, p) >= 0 && turn_of(c, a, p) >= 0;
    });
  }

  const std::vector<Vec3>& vertices_;
  std::vector<std::uint32_t> face_;    // what is left of it
  std::vector<std::uint32_t> reflex_;  // of these, those that are not convex
  int axis_{0};
  int side_{1};
  double tolerance_{0};  // [m] as the vertices
  bool has_area_{true};
};

/// Times a power of two that brings the largest coordinate near one, so that products of them
/// neither overflow nor vanish.
std::vector<Vec3> scaled_to_one(std::vector<Vec3> vertices) {
  double largest = 0;
  for (const Vec3& v : vertices) {
    largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  }
  if (!(largest > 0)) return vertices;
  const int exponent = -std::ilogb(largest);
  for (Vec3& v : vertices) {
    for (int axis = 0; axis < 3; ++axis) v[axis] = std::ldexp(v[axis], exponent);
  }
  return vertices;
}

}  // namespace

void PolygonMesh::add_face(std::span<const std::uint32_t> face) {
  corners.insert(corners.end(), face.begin(), face.end());
  first_corner.push_back(corners.size());
}

TriangleMesh triangulated(PolygonMesh mesh,
                          const std::function<std::string(std::size_t face)>& place_of) {
  TriangleMesh result;
  result.vertices = std::move(mesh.vertices);
  std::vector<Vec3> scaled;  // made for the first face that is no triangle
  for (std::size_t f = 0; f < mesh.faces(); ++f) {
    std::vector<std::uint32_t> face;
    for (std::size_t c = mesh.first_corner[f]; c < mesh.first_corner[f + 1]; ++c) {
      const Vec3& place = result.vertices[mesh.corners[c]];
      if (face.empty() || !(place == result.vertices[face.back()])) face.push_back(mesh.corners[c]);
    }
    while (face.size() > 1 && result.vertices[face.front()] == result.vertices[face.back()]) {
      face.pop_back();
    }
    if (face.size() < 3) continue;
    const std::size_t corners = face.size();
    if (corners == 3) {
      result.triangles.push_back({face[0], face[1], face[2]});
      continue;
    }
    if (scaled.empty()) scaled = scaled_to_one(result.vertices);
    if (EarClipping{scaled, std::move(face)}.run(result.triangles)) continue;
    throw Error{
        {.place = place_of(f),
         .problem = "the outline of a face crosses or touches itself",
         .reason = "its " + std::to_string(corners) + " corners enclose no simple polygon",
         .fix = "Split the face into triangles in a mesh editor and write the file again."}};
  }
  return result;
}

}  // namespace reckon
