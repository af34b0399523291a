// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/rounded_polyhedron.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace reckon {
namespace {

using Polygon = std::vector<Vec3>;

/// The part of a convex polygon inside a half space (Sutherland & Hodgman 1974).
Polygon clipped(const Polygon& polygon, const HalfSpace& half_space) {
  Polygon inside;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const Vec3& from = polygon[n];
    const Vec3& to = polygon[(n + 1) % polygon.size()];
    const double depth_from = half_space.offset - dot(half_space.normal, from);
    const double depth_to = half_space.offset - dot(half_space.normal, to);
    if (depth_from >= 0) inside.push_back(from);
    if ((depth_from > 0 && depth_to < 0) || (depth_from < 0 && depth_to > 0)) {
      inside.push_back(from + (depth_from / (depth_from - depth_to)) * (to - from));
    }
  }
  return inside;
}

/// A square on the half space's plane that reaches at least `reach` in every direction.
Polygon plane_square(const HalfSpace& half_space, double reach) {
  const Vec3& n = half_space.normal;
  const Vec3 helper = std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = reach * normalized(cross(helper, n));
  const Vec3 v = cross(n, u);
  const Vec3 center = half_space.offset * n;
  return {center - u - v, center + u - v, center + u + v, center - u + v};
}

/// The part of half space i's plane that lies in all others.
Polygon face_of(const std::vector<HalfSpace>& half_spaces, std::size_t i) {
  double largest_offset = 0;
  for (const HalfSpace& h : half_spaces) {
    largest_offset = std::max(largest_offset, std::abs(h.offset));
  }
  // Far enough for any corner of a body that is not extremely slender.
  Polygon face = plane_square(half_spaces[i], 100 * largest_offset);
  for (std::size_t j = 0; j < half_spaces.size() && !face.empty(); ++j) {
    if (j != i) face = clipped(face, half_spaces[j]);
  }
  return face;
}

bool is_empty(const std::vector<HalfSpace>& half_spaces) {
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    if (face_of(half_spaces, i).size() >= 3) return false;
  }
  return true;
}

std::vector<HalfSpace> moved_inward(std::vector<HalfSpace> half_spaces, double distance) {
  for (HalfSpace& half_space : half_spaces) half_space.offset -= distance;
  return half_spaces;
}

TriangleMesh fans(const std::vector<Polygon>& faces) {
  TriangleMesh mesh;
  for (const Polygon& face : faces) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), face.begin(), face.end());
    for (std::uint32_t n = 2; n < face.size(); ++n) {
      mesh.triangles.push_back({first, first + n - 1, first + n});
    }
  }
  return mesh;
}

}  // namespace

std::vector<Polygon> polyhedron_faces(const std::vector<HalfSpace>& half_spaces) {
  std::vector<Polygon> faces;
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    Polygon face = face_of(half_spaces, i);
    if (face.size() >= 3) faces.push_back(std::move(face));
  }
  return faces;
}

double inscribed_radius(const std::vector<HalfSpace>& half_spaces) {
  double low = 0;
  double high = 0;
  for (const HalfSpace& h : half_spaces) high = std::max(high, h.offset);
  while (high - low > 1e-9 * high) {
    const double middle = 0.5 * (low + high);
    (is_empty(moved_inward(half_spaces, middle)) ? high : low) = middle;
  }
  return low;
}

RoundedPolyhedron::RoundedPolyhedron(std::vector<HalfSpace> half_spaces, double roundness)
    : half_spaces_{std::move(half_spaces)} {
  if (roundness <= 0) return;
  corner_radius_ = roundness * inscribed_radius(half_spaces_);
  core_.emplace(fans(polyhedron_faces(moved_inward(half_spaces_, corner_radius_))));
}

double RoundedPolyhedron::radius(const Vec3& direction) const {
  double t = std::numeric_limits<double>::infinity();
  for (const HalfSpace& h : half_spaces_) {
    const double rate = dot(h.normal, direction);
    if (rate > 0) t = std::min(t, h.offset / rate);
  }
  if (!core_) return t;
  // The distance to the core grows along the ray as a convex function, and it is at least the
  // corner radius on the sharp polyhedron: Newton's method descends to the root from there.
  constexpr int most_rounds = 50;
  for (int round = 0; round < most_rounds; ++round) {
    const Vec3 point = t * direction;
    const ClosestPoint closest = core_->closest_point(point);
    const double distance = std::sqrt(closest.squared_distance);
    const double slope = dot(point - closest.point, direction) / distance;
    const double step = (distance - corner_radius_) / slope;
    t -= step;
    if (!(step > 1e-13 * t)) break;
  }
  return t;
}

}  // namespace reckon
