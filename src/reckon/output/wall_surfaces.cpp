// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/wall_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "reckon/math/portable.hpp"

namespace reckon {
namespace {

constexpr double parallel = 0.999;     // cosine from which two directions count as one
constexpr double margin_share = 0.06;  // of the grains' diagonal, beyond them
constexpr int facets = 72;             // of a cylinder

struct Frame {
  Vec3 u, v;
};
/// Two directions at right angles to a unit vector and to each other.
Frame across(const Vec3& axis_unit) {
  const Vec3 other = std::abs(axis_unit.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(axis_unit, other));
  return {u, cross(axis_unit, u)};
}

std::array<Vec3, 8> corners_of(const Extent& box) {
  std::array<Vec3, 8> corners;
  for (std::size_t n = 0; n < 8; ++n) {
    corners[n] = {(n & 1U) != 0 ? box.high.x : box.low.x, (n & 2U) != 0 ? box.high.y : box.low.y,
                  (n & 4U) != 0 ? box.high.z : box.low.z};
  }
  return corners;
}

class Drawing {
 public:
  Drawing(std::span<const Wall> walls, std::span<const Vec3> displacement, const Extent& grains)
      : size_{norm(grains.high - grains.low)}, center_{0.5 * (grains.low + grains.high)} {
    const double margin = margin_share * size_;
    limits_ = {grains.low - Vec3{margin, margin, margin},
               grains.high + Vec3{margin, margin, margin}};
    for (std::size_t n = 0; n < walls.size(); ++n) {
      WallSurface surface = walls[n].surface;
      const Vec3 shift = n < displacement.size() ? displacement[n] : Vec3{};
      std::visit([&](auto& wall) { wall.point += shift; }, surface);
      standing_.push_back(surface);
    }
  }

  void add(std::uint32_t wall, WallPolygons& drawn) const {
    if (const auto* plane = std::get_if<PlaneSurface>(&standing_[wall])) {
      add_polygon(wall, polygon_of(wall, *plane), drawn);
    } else if (const auto* ledge = std::get_if<LedgeSurface>(&standing_[wall])) {
      const PlaneSurface side{ledge->point, ledge->normal_unit};
      const PlaneSurface top{ledge->point, ledge->top_unit};
      const auto solid_of = [](const PlaneSurface& face) {
        return PlaneSurface{face.point, -face.normal_unit};
      };
      add_polygon(wall, clipped(polygon_of(wall, side), solid_of(top)), drawn);
      add_polygon(wall, clipped(polygon_of(wall, top), solid_of(side)), drawn);
    } else {
      add_cylinder(wall, std::get<CylinderSurface>(standing_[wall]), drawn);
    }
  }

 private:
  static void add_polygon(std::uint32_t wall, std::span<const Vec3> polygon, WallPolygons& drawn) {
    if (polygon.size() < 3) return;
    for (const Vec3& corner : polygon) {
      drawn.polygons.connectivity.push_back(static_cast<std::int64_t>(drawn.corners.size()));
      drawn.corners.push_back(corner);
    }
    drawn.polygons.offsets.push_back(static_cast<std::int64_t>(drawn.polygons.connectivity.size()));
    drawn.wall.push_back(wall);
  }

  [[nodiscard]] std::vector<Vec3> polygon_of(std::uint32_t own, const PlaneSurface& plane) const {
    const Frame frame = across(plane.normal_unit);
    const Vec3 foot = center_ - plane.distance(center_) * plane.normal_unit;
    const double reach = 2 * size_;
    std::vector<Vec3> polygon{
        foot - reach * frame.u - reach * frame.v, foot + reach * frame.u - reach * frame.v,
        foot + reach * frame.u + reach * frame.v, foot - reach * frame.u + reach * frame.v};
    const auto cut = [&](const PlaneSurface& by) {
      // One that is parallel would take all or nothing.
      if (std::abs(dot(by.normal_unit, plane.normal_unit)) < parallel) {
        polygon = clipped(polygon, by);
      }
    };
    for (std::uint32_t n = 0; n < standing_.size(); ++n) {
      if (n == own) continue;
      if (const auto* other = std::get_if<PlaneSurface>(&standing_[n])) {
        cut(*other);
      } else if (const auto* cylinder = std::get_if<CylinderSurface>(&standing_[n])) {
        if (std::abs(dot(cylinder->axis_unit, plane.normal_unit)) < parallel) continue;
        const Frame ring = across(cylinder->axis_unit);
        for (int facet = 0; facet < facets; ++facet) {
          const Vec3 out = direction(ring, facet + 0.5);
          const double apothem = cylinder->radius * portable::cos_sin_of_turns(0.5 / facets).cos;
          cut({cylinder->point + apothem * out, -out});
        }
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 inward;
      inward[axis] = 1;
      cut({limits_.low, inward});
      cut({limits_.high, -inward});
    }
    return polygon;
  }

  /// Around the ring, in units of a facet.
  static Vec3 direction(const Frame& ring, double facet) {
    const auto [cosine, sine] = portable::cos_sin_of_turns(facet / facets);
    return cosine * ring.u + sine * ring.v;
  }

  void add_cylinder(std::uint32_t own, const CylinderSurface& cylinder, WallPolygons& drawn) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vec3& corner : corners_of(limits_)) {
      const double height = dot(corner - cylinder.point, cylinder.axis_unit);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    for (const WallSurface& wall : standing_) {  // planes at its ends
      const auto* end = std::get_if<PlaneSurface>(&wall);
      if (end == nullptr) continue;
      const double facing = dot(end->normal_unit, cylinder.axis_unit);
      if (std::abs(facing) < parallel) continue;
      const double height = dot(end->point - cylinder.point, cylinder.axis_unit);
      if (facing > 0) low = std::max(low, height);
      if (facing < 0) high = std::min(high, height);
    }
    if (!(low < high)) return;
    // Facets share their corners, so that only the rims count as edges.
    const Frame ring = across(cylinder.axis_unit);
    const auto first = static_cast<std::int64_t>(drawn.corners.size());
    for (int facet = 0; facet < facets; ++facet) {
      const Vec3 place = cylinder.point + cylinder.radius * direction(ring, facet);
      drawn.corners.push_back(place + low * cylinder.axis_unit);
      drawn.corners.push_back(place + high * cylinder.axis_unit);
    }
    for (std::int64_t facet = 0; facet < facets; ++facet) {
      const std::int64_t here = first + 2 * facet;
      const std::int64_t next = first + 2 * ((facet + 1) % facets);
      auto& points = drawn.polygons.connectivity;
      points.insert(points.end(), {here, next, next + 1, here + 1});
      drawn.polygons.offsets.push_back(static_cast<std::int64_t>(points.size()));
      drawn.wall.push_back(own);
    }
  }

  double size_;
  Vec3 center_;
  Extent limits_;
  std::vector<WallSurface> standing_;
};

}  // namespace

std::vector<Vec3> clipped(std::span<const Vec3> polygon, const PlaneSurface& plane) {
  std::vector<Vec3> result;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const Vec3& from = polygon[n];
    const Vec3& to = polygon[(n + 1) % polygon.size()];
    const double height = plane.distance(from);
    const double next = plane.distance(to);
    if (height >= 0) result.push_back(from);
    if ((height >= 0) != (next >= 0))
      result.push_back(from + height / (height - next) * (to - from));
  }
  return result;
}

WallPolygons wall_polygons(std::span<const Wall> walls, std::span<const Vec3> displacement,
                           const Extent& grains, std::optional<std::uint32_t> absent) {
  WallPolygons drawn;
  const Drawing drawing{walls, displacement, grains};
  for (std::uint32_t wall = 0; wall < walls.size(); ++wall) {
    if (wall != absent) drawing.add(wall, drawn);
  }
  return drawn;
}

}  // namespace reckon
