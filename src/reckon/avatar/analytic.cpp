// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/analytic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/core/error.hpp"
#include "reckon/math/portable.hpp"

namespace reckon {
namespace {

void require_length(double length, std::string_view solid, std::string_view what) {
  if (length > 0 && std::isfinite(length)) return;
  throw Error{{.place = std::string{solid},
               .problem = "has a " + std::string{what} + " of " + std::to_string(length) + " m",
               .reason = "lengths must be positive and finite",
               .fix = "Give a length above zero."}};
}

void require_lengths(const Vec3& lengths, std::string_view solid, std::string_view what) {
  for (int axis = 0; axis < 3; ++axis) require_length(lengths[axis], solid, what);
}

double largest(const Vec3& v) { return std::max({v.x, v.y, v.z}); }

/// How many pieces of at most `target` make up `length`.
std::uint32_t pieces(double length, double target, std::string_view solid) {
  require_length(target, solid, "target edge");
  const double count = std::ceil(length / target);
  if (!(count <= highest_frequency)) {
    throw Error{{.place = std::string{solid},
                 .problem = "would need " + std::to_string(count) + " mesh edges along one side",
                 .reason = "the limit is " + std::to_string(highest_frequency),
                 .fix = "Choose a longer target edge."}};
  }
  return std::max(1U, static_cast<std::uint32_t>(count));
}

/// The boundary of a grid of n[0] * n[1] * n[2] cells, as a mesh of grid places.
class BoxSurface {
 public:
  using Place = std::array<std::uint32_t, 3>;

  explicit BoxSurface(const Place& cells) : cells_{cells} {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      add_side(axis, 0);
      add_side(axis, cells_[axis]);
    }
  }
  [[nodiscard]] const std::vector<Place>& places() const { return places_; }
  [[nodiscard]] const std::vector<TriangleMesh::Triangle>& triangles() const { return triangles_; }

 private:
  std::uint32_t vertex(const Place& place) {
    const auto [found, is_new] =
        index_.try_emplace(place, static_cast<std::uint32_t>(places_.size()));
    if (is_new) places_.push_back(place);
    return found->second;
  }

  void add_side(std::size_t axis, std::uint32_t level) {
    // (axis, u, v) is right-handed, so u before v is counter-clockwise seen from the positive side.
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    Place place{};
    place[axis] = level;
    for (std::uint32_t i = 0; i < cells_[u]; ++i) {
      for (std::uint32_t j = 0; j < cells_[v]; ++j) {
        const auto corner = [&](std::uint32_t du, std::uint32_t dv) {
          place[u] = i + du;
          place[v] = j + dv;
          return vertex(place);
        };
        const std::uint32_t a = corner(0, 0);
        const std::uint32_t b = corner(1, 0);
        const std::uint32_t c = corner(1, 1);
        const std::uint32_t d = corner(0, 1);
        if (level == 0) {
          triangles_.push_back({a, c, b});
          triangles_.push_back({a, d, c});
        } else {
          triangles_.push_back({a, b, c});
          triangles_.push_back({a, c, d});
        }
      }
    }
  }

  Place cells_;
  std::vector<Place> places_;
  std::vector<TriangleMesh::Triangle> triangles_;
  std::map<Place, std::uint32_t> index_;
};

/// Rings of vertices around z, each with `sides` vertices, joined to a closed surface between two
/// poles. All rings start in the x-z plane.
TriangleMesh joined_rings(const std::vector<std::pair<double, double>>& radius_and_z, double pole_z,
                          std::uint32_t sides) {
  TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, -pole_z});
  for (const auto& [radius, z] : radius_and_z) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const auto [cosine, sine] = portable::cos_sin_of_turns(static_cast<double>(s) / sides);
      mesh.vertices.push_back({radius * cosine, radius * sine, z});
    }
  }
  mesh.vertices.push_back({0, 0, pole_z});

  const auto rings = static_cast<std::uint32_t>(radius_and_z.size());
  const std::uint32_t top = rings * sides + 1;
  for (std::uint32_t s = 0; s < sides; ++s) {
    const std::uint32_t next = (s + 1) % sides;
    mesh.triangles.push_back({0, 1 + next, 1 + s});
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
      const std::uint32_t low = 1 + ring * sides;
      const std::uint32_t high = low + sides;
      mesh.triangles.push_back({low + s, low + next, high + next});
      mesh.triangles.push_back({low + s, high + next, high + s});
    }
    const std::uint32_t last = top - sides;
    mesh.triangles.push_back({top, last + s, last + next});
  }
  return mesh;
}

}  // namespace

TriangleMesh sphere_mesh(double radius, double target_edge) {
  return ellipsoid_mesh({radius, radius, radius}, target_edge);
}

TriangleMesh ellipsoid_mesh(const Vec3& half_axes, double target_edge) {
  require_lengths(half_axes, "ellipsoid", "half-axis");
  TriangleMesh mesh = geodesic_sphere(geodesic_frequency(largest(half_axes), target_edge));
  for (Vec3& v : mesh.vertices) v = hadamard(half_axes, v);
  return mesh;
}

Vec3 Superellipsoid::surface_point(const Vec3& direction) const {
  using portable::pow;
  const Vec3 scaled{std::abs(direction.x / half_extents.x), std::abs(direction.y / half_extents.y),
                    std::abs(direction.z / half_extents.z)};
  // Dividing by the largest keeps the powers from underflowing; the gauge is homogeneous.
  const double size = largest(scaled);
  const double outline =
      pow(pow(scaled.x / size, 2 / exponent_xy) + pow(scaled.y / size, 2 / exponent_xy),
          exponent_xy / exponent_z);
  const double gauge = size * pow(outline + pow(scaled.z / size, 2 / exponent_z), exponent_z / 2);
  return direction / gauge;
}

TriangleMesh superellipsoid_mesh(const Superellipsoid& solid, double target_edge) {
  require_lengths(solid.half_extents, "superellipsoid", "half-extent");
  for (const double exponent : {solid.exponent_xy, solid.exponent_z}) {
    if (exponent >= Superellipsoid::lowest_exponent && exponent <= 2) continue;
    throw Error{
        {.place = "superellipsoid",
         .problem = "has an exponent of " + std::to_string(exponent),
         .reason = "exponents lie in [" + std::to_string(Superellipsoid::lowest_exponent) + ", 2]",
         .fix = "Choose exponents in that range; 1 gives an ellipsoid."}};
  }
  // The surface bends sharply across the coordinate planes, so the mesh has edges along them.
  const double reach = largest(solid.half_extents);
  TriangleMesh mesh = geodesic_sphere(
      geodesic_frequency(reach, target_edge, GeodesicBase::octahedron), GeodesicBase::octahedron);
  for (Vec3& v : mesh.vertices) v = solid.surface_point(hadamard(solid.half_extents, v));
  return mesh;
}

TriangleMesh box_mesh(const Vec3& half_extents, double target_edge) {
  require_lengths(half_extents, "box", "half-extent");
  const BoxSurface::Place cells{pieces(2 * half_extents.x, target_edge, "box"),
                                pieces(2 * half_extents.y, target_edge, "box"),
                                pieces(2 * half_extents.z, target_edge, "box")};
  const BoxSurface surface{cells};
  TriangleMesh mesh{{}, surface.triangles()};
  for (const BoxSurface::Place& place : surface.places()) {
    const auto coordinate = [&](std::size_t axis, double half) {
      // Symmetric about 0, and exact at both ends.
      return half * ((2.0 * place[axis] - cells[axis]) / cells[axis]);
    };
    mesh.vertices.push_back({coordinate(0, half_extents.x), coordinate(1, half_extents.y),
                             coordinate(2, half_extents.z)});
  }
  return mesh;
}

TriangleMesh cylinder_mesh(double radius, double half_height, double target_edge) {
  require_length(radius, "cylinder", "radius");
  require_length(half_height, "cylinder", "half-height");
  const std::uint32_t sides =
      std::max(8U, pieces(2 * std::numbers::pi * radius, target_edge, "cylinder"));
  const std::uint32_t cap_rings = pieces(radius, target_edge, "cylinder");
  const std::uint32_t layers = pieces(2 * half_height, target_edge, "cylinder");
  std::vector<std::pair<double, double>> rings;
  for (std::uint32_t n = 1; n <= cap_rings; ++n) {
    rings.emplace_back(radius * (static_cast<double>(n) / cap_rings), -half_height);
  }
  for (std::uint32_t n = 1; n <= layers; ++n) {
    rings.emplace_back(radius, half_height * ((2.0 * n - layers) / layers));
  }
  for (std::uint32_t n = cap_rings - 1; n >= 1; --n) {
    rings.emplace_back(radius * (static_cast<double>(n) / cap_rings), half_height);
  }
  return joined_rings(rings, half_height, sides);
}

double BoxDistance::operator()(const Vec3& point) const {
  const Vec3 beyond{std::abs(point.x) - half_extents.x, std::abs(point.y) - half_extents.y,
                    std::abs(point.z) - half_extents.z};
  const Vec3 outside{std::max(beyond.x, 0.0), std::max(beyond.y, 0.0), std::max(beyond.z, 0.0)};
  return norm(outside) + std::min(largest(beyond), 0.0);
}

double CylinderDistance::operator()(const Vec3& point) const {
  const double beyond_side = std::sqrt(point.x * point.x + point.y * point.y) - radius;
  const double beyond_cap = std::abs(point.z) - half_height;
  const double out_side = std::max(beyond_side, 0.0);
  const double out_cap = std::max(beyond_cap, 0.0);
  return std::sqrt(out_side * out_side + out_cap * out_cap) +
         std::min(std::max(beyond_side, beyond_cap), 0.0);
}

}  // namespace reckon
