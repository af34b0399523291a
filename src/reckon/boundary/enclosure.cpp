// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/enclosure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace reckon {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Plane {
  std::size_t wall;
  Vec3 normal_unit;
  double offset;  // points inside have dot(normal, p) >= offset [m]
};

Plane placed(std::size_t wall, const PlaneSurface& surface, const WallPose& pose) {
  return {wall, surface.normal_unit, dot(surface.normal_unit, surface.point + pose.displacement)};
}

/// The axis that the normal of a plane lies along, if it does.
std::optional<int> axis_of(const Plane& plane) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(plane.normal_unit[axis]) == 1) return axis;
  }
  return std::nullopt;
}

/// Between planes across the axes: the usual box, by three products.
std::optional<Enclosure> right_box(std::span<const Plane> planes, std::size_t wall_count) {
  std::array<const Plane*, 3> lows{};
  std::array<const Plane*, 3> highs{};
  Enclosure box{0, {-infinity, -infinity, -infinity}, {infinity, infinity, infinity}, {}};
  for (const Plane& plane : planes) {
    const auto axis = static_cast<std::size_t>(*axis_of(plane));
    const int a = static_cast<int>(axis);
    if (plane.normal_unit[a] > 0 && plane.offset > box.low[a]) {
      box.low[a] = plane.offset;
      lows[axis] = &plane;
    } else if (plane.normal_unit[a] < 0 && -plane.offset < box.high[a]) {
      box.high[a] = -plane.offset;
      highs[axis] = &plane;
    }
  }
  const Vec3 size = box.size();
  if (!is_finite(size) || !(std::min({size.x, size.y, size.z}) > 0)) return std::nullopt;
  box.volume = size.x * size.y * size.z;
  box.areas.assign(wall_count, 0);
  for (int a = 0; a < 3; ++a) {
    const double area = size[(a + 1) % 3] * size[(a + 2) % 3];
    box.areas[lows[static_cast<std::size_t>(a)]->wall] = area;
    box.areas[highs[static_cast<std::size_t>(a)]->wall] = area;
  }
  return box;
}

struct Face {
  const Plane* plane{nullptr};  // none: of the block that is cut
  std::vector<Vec3> corners;
};

/// A block around where the planes are, so large that what remains of it shows an open space.
std::vector<Face> large_block(const Vec3& centre, double half) {
  std::vector<Face> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-half, half}) {
      Face face;
      for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        Vec3 corner = centre;
        corner[axis] += side;
        corner[(axis + 1) % 3] += u * half;
        corner[(axis + 2) % 3] += v * half;
        face.corners.push_back(corner);
      }
      faces.push_back(std::move(face));
    }
  }
  return faces;
}

/// Puts points of a convex outline into order around their mean. Angles are compared through
/// v / (|u| + |v|), which grows with them and needs no arc tangent.
void order_around(const Vec3& normal, std::vector<Vec3>& points) {
  Vec3 mean;
  for (const Vec3& p : points) mean += p / static_cast<double>(points.size());
  const Vec3 any = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u_axis = normalized(cross(normal, any));
  const Vec3 v_axis = cross(normal, u_axis);
  const auto angle = [&](const Vec3& p) {
    const double u = dot(p - mean, u_axis);
    const double v = dot(p - mean, v_axis);
    const double length = std::abs(u) + std::abs(v);
    if (!(length > 0)) return 0.0;
    return u >= 0 ? v / length : 2 - v / length;
  };
  std::sort(points.begin(), points.end(),
            [&](const Vec3& p, const Vec3& q) { return angle(p) < angle(q); });
}

/// Keeps the part of a convex body with dot(normal, p) >= offset (Sutherland and Hodgman, face by
/// face) and closes the cut.
void cut(std::vector<Face>& faces, const Plane& plane) {
  Face lid{&plane, {}};
  for (Face& face : faces) {
    std::vector<Vec3> kept;
    for (std::size_t n = 0; n < face.corners.size(); ++n) {
      const Vec3& p = face.corners[n];
      const Vec3& q = face.corners[(n + 1) % face.corners.size()];
      const double height_p = dot(plane.normal_unit, p) - plane.offset;
      const double height_q = dot(plane.normal_unit, q) - plane.offset;
      if (height_p >= 0) kept.push_back(p);
      if ((height_p >= 0) != (height_q >= 0)) {
        const Vec3 crossing = p + (height_p / (height_p - height_q)) * (q - p);
        kept.push_back(crossing);
        lid.corners.push_back(crossing);
      }
    }
    face.corners = std::move(kept);
  }
  if (lid.corners.empty()) return;
  order_around(plane.normal_unit, lid.corners);
  faces.push_back(std::move(lid));
}

/// A vector along the face's normal, as long as its area.
Vec3 area_vector(const Face& face) {
  Vec3 sum;
  for (std::size_t n = 2; n < face.corners.size(); ++n) {
    sum += 0.5 * cross(face.corners[n - 1] - face.corners[0], face.corners[n] - face.corners[0]);
  }
  return sum;
}

std::optional<Enclosure> convex_body(std::span<const Plane> planes, std::size_t wall_count) {
  Vec3 centre;
  for (const Plane& plane : planes) {
    centre += plane.offset * plane.normal_unit / static_cast<double>(planes.size());
  }
  double reach = 0;
  for (const Plane& plane : planes) {
    reach = std::max(reach, std::abs(dot(plane.normal_unit, centre) - plane.offset));
  }
  if (!(reach > 0)) return std::nullopt;
  std::vector<Face> faces = large_block(centre, 100 * reach);
  for (const Plane& plane : planes) cut(faces, plane);
  Enclosure body{0, {infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, {}};
  body.areas.assign(wall_count, 0);
  for (const Face& face : faces) {
    if (face.corners.size() < 3) continue;
    const double area = norm(area_vector(face));
    if (face.plane == nullptr) {
      if (area > 0) return std::nullopt;  // some of the block is left: open to that side
      continue;
    }
    body.areas[face.plane->wall] = area;
    // A pyramid below the centre, which may lie outside: planes that bound nothing count in it.
    body.volume += area / 3 * (dot(face.plane->normal_unit, centre) - face.plane->offset);
    for (const Vec3& p : face.corners) {
      for (int axis = 0; axis < 3; ++axis) {
        body.low[axis] = std::min(body.low[axis], p[axis]);
        body.high[axis] = std::max(body.high[axis], p[axis]);
      }
    }
  }
  if (!(body.volume > 0)) return std::nullopt;
  return body;
}

std::optional<ClosedCylinder> between(std::span<const Plane> planes,
                                      const CylinderSurface& cylinder, const Vec3& displacement) {
  const Vec3& axis = cylinder.axis_unit;
  const Vec3 point = cylinder.point + displacement;
  const Plane* floor = nullptr;
  const Plane* lid = nullptr;
  double low = -infinity;  // along the axis, from the point
  double high = infinity;
  for (const Plane& plane : planes) {
    const double slope = dot(plane.normal_unit, axis);
    if (std::abs(std::abs(slope) - 1) > 1e-12) return std::nullopt;
    const double place = (plane.offset - dot(plane.normal_unit, point)) / slope;
    if (slope > 0 && place > low) {
      low = place;
      floor = &plane;
    } else if (slope < 0 && place < high) {
      high = place;
      lid = &plane;
    }
  }
  if (floor == nullptr || lid == nullptr || !(high > low)) return std::nullopt;
  return ClosedCylinder{{point + low * axis, axis, cylinder.radius, high - low},
                        WallId{static_cast<std::uint32_t>(floor->wall)},
                        WallId{static_cast<std::uint32_t>(lid->wall)}};
}

std::vector<Plane> placed_planes(std::span<const Wall> walls, std::span<const WallPose> poses) {
  std::vector<Plane> planes;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (const auto* plane = std::get_if<PlaneSurface>(&walls[w].surface)) {
      planes.push_back(placed(w, *plane, poses[w]));
    }
  }
  return planes;
}

Enclosure inside(const ClosedCylinder& cylinder, std::size_t cylinder_wall,
                 std::size_t wall_count) {
  const auto& [foot, axis, r, height] = cylinder.place;
  Enclosure body{std::numbers::pi * r * r * height, {}, {}, std::vector<double>(wall_count, 0)};
  body.areas[cylinder.floor.get()] = body.areas[cylinder.lid.get()] = std::numbers::pi * r * r;
  body.areas[cylinder_wall] = 2 * std::numbers::pi * r * height;
  for (int a = 0; a < 3; ++a) {
    const double rim = r * std::sqrt(std::max(0.0, 1 - axis[a] * axis[a]));
    const double end = foot[a];
    const double other_end = foot[a] + height * axis[a];
    body.low[a] = std::min(end, other_end) - rim;
    body.high[a] = std::max(end, other_end) + rim;
  }
  return body;
}

/// Inside all planes.
std::optional<Enclosure> inside(std::span<const Plane> planes, std::size_t wall_count) {
  const bool all_across_axes = std::all_of(planes.begin(), planes.end(),
                                           [](const Plane& p) { return axis_of(p).has_value(); });
  return all_across_axes ? right_box(planes, wall_count) : convex_body(planes, wall_count);
}

/// A shear box. The cut has the place behind all walls, which goes at the end.
std::optional<Enclosure> shear_box(std::span<const Wall> walls, std::span<const WallPose> poses,
                                   const Vec3& up) {
  const std::size_t cut = walls.size();
  std::array<std::vector<Plane>, 2> sides;  // of the lower half, whose tops point up; the upper
  std::array<double, 2> heights{};
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const auto* ledge = std::get_if<LedgeSurface>(&walls[w].surface);
    if (ledge == nullptr) continue;
    const double slope = dot(ledge->top_unit, up);
    if (std::abs(std::abs(slope) - 1) > 1e-12) return std::nullopt;
    const std::size_t half = slope > 0 ? 0 : 1;
    const Vec3 edge = ledge->point + poses[w].displacement;
    sides[half].push_back({w, ledge->normal_unit, dot(ledge->normal_unit, edge)});
    heights[half] += dot(up, edge);
  }
  if (sides[0].empty() || sides[1].empty()) return std::nullopt;
  const double height = 0.5 * (heights[0] / static_cast<double>(sides[0].size()) +
                               heights[1] / static_cast<double>(sides[1].size()));
  std::optional<Enclosure> whole;
  for (const std::size_t half : {0U, 1U}) {
    std::vector<Plane> planes = placed_planes(walls, poses);
    planes.insert(planes.end(), sides[half].begin(), sides[half].end());
    planes.push_back(half == 0 ? Plane{cut, -up, -height} : Plane{cut, up, height});
    const auto part = inside(planes, walls.size() + 1);
    if (!part) return std::nullopt;
    if (!whole) {
      whole = part;
      continue;
    }
    whole->volume += part->volume;
    for (int axis = 0; axis < 3; ++axis) {
      whole->low[axis] = std::min(whole->low[axis], part->low[axis]);
      whole->high[axis] = std::max(whole->high[axis], part->high[axis]);
    }
    for (std::size_t w = 0; w < cut; ++w) whole->areas[w] += part->areas[w];
  }
  whole->areas.pop_back();
  return whole;
}

}  // namespace

std::optional<Enclosure> enclosure_of(std::span<const Wall> walls,
                                      std::span<const WallPose> poses) {
  const std::vector<Plane> planes = placed_planes(walls, poses);
  std::optional<std::size_t> cylinder;
  const LedgeSurface* ledge = nullptr;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (const auto* found = std::get_if<LedgeSurface>(&walls[w].surface)) ledge = found;
    if (!std::holds_alternative<CylinderSurface>(walls[w].surface)) continue;
    if (cylinder) return std::nullopt;
    cylinder = w;
  }
  if (cylinder && ledge != nullptr) return std::nullopt;
  if (ledge != nullptr) return shear_box(walls, poses, ledge->top_unit);
  if (cylinder) {
    const auto closed = between(planes, std::get<CylinderSurface>(walls[*cylinder].surface),
                                poses[*cylinder].displacement);
    if (!closed) return std::nullopt;
    return inside(*closed, *cylinder, walls.size());
  }
  return inside(planes, walls.size());
}

std::optional<ClosedCylinder> closed_cylinder(std::span<const Wall> walls,
                                              std::span<const WallPose> poses, WallId cylinder) {
  return between(placed_planes(walls, poses),
                 std::get<CylinderSurface>(walls[cylinder.get()].surface),
                 poses[cylinder.get()].displacement);
}

}  // namespace reckon
