// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/near_wall.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reckon/contact/displacement_bound.hpp"
#include "reckon/contact/near_skin.hpp"
#include "reckon/contact/sphere_contact.hpp"

namespace reckon {
namespace {

/// Far more than the rounding of places and distances, walls being at most so far from the origin.
double rounding_margin(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                       double path_length) {
  const double size = std::visit(
      [&](const auto& surface) {
        const Vec3 from_wall = grain.position - pose.displacement - surface.point;
        return norm(grain.position) + norm(pose.displacement) + norm(from_wall);
      },
      wall.surface);
  return 1e-12 * grain.shape->bounding_radius +
         32 * std::numeric_limits<double>::epsilon() * (path_length + size);
}

/// Tests one node and hands it on when it touches. Returns its distance.
template <class Surface>
double test_node(const GrainFrame& grain, const Wall& wall, const Surface& surface,
                 const Vec3& center, NodeIndex node, const Vec3& place_body, double area,
                 std::vector<Touch>& touches) {
  Vec3 lever = grain.rotation * place_body;
  const Vec3 point = center + lever;
  const double phi = surface.distance(point);
  if (phi < 0) {
    if (wall.shortened_lever) lever *= 1 + phi / norm(lever);
    touches.push_back({node, phi, surface.gradient(point), lever, area});
  }
  return phi;
}

/// Whether touches of this grain need no nodes.
bool is_sphere_on_plane(const GrainFrame& grain, const Wall& wall) {
  return grain.shape->sphere_radius > 0 && !wall.shortened_lever &&
         std::holds_alternative<PlaneSurface>(wall.surface);
}

/// A sphere on a plane, which is a sphere without end: see touch_spheres.
void touch_plane(const GrainFrame& grain, const Wall& wall, double from_center,
                 std::vector<Touch>& touches) {
  const double radius = grain.shape->sphere_radius;
  const Vec3& normal = std::get<PlaneSurface>(wall.surface).normal_unit;
  add_cap_touches(radius - from_center, radius, normal, -from_center * normal, touches);
}

}  // namespace

double distance(const Wall& wall, const WallPose& pose, const Vec3& point) {
  return std::visit([&](const auto& s) { return s.distance(point - pose.displacement); },
                    wall.surface);
}

void find_wall_touches(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                       std::vector<Touch>& touches) {
  const ShapeView& shape = *grain.shape;
  const double from_center = distance(wall, pose, grain.position);
  if (is_sphere_on_plane(grain, wall)) return touch_plane(grain, wall, from_center, touches);
  if (!(from_center < shape.bounding_radius)) return;
  std::visit(
      [&](const auto& surface) {
        const Vec3 center = grain.position - pose.displacement;
        for (NodeIndex n = 0; n < shape.nodes.size(); ++n) {
          test_node(grain, wall, surface, center, n, shape.nodes.position(n), shape.nodes.area[n],
                    touches);
        }
      },
      wall.surface);
}

double NearWall::find_touches(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                              double path_length, std::vector<Touch>& touches,
                              ContactCounters& counters) {
  const double margin = rounding_margin(grain, wall, pose, path_length);
  const double from_center = distance(wall, pose, grain.position);
  if (is_sphere_on_plane(grain, wall)) {
    touch_plane(grain, wall, from_center, touches);
    const double apart = from_center - grain.shape->sphere_radius - margin;
    return from_center < grain.shape->sphere_radius ? check_always
                                                    : path_length + std::max(apart, 0.0);
  }
  const double radius = list_.exists() ? list_.partner().radius : grain.shape->bounding_radius;
  if (!(from_center < radius)) return path_length + std::max(from_center - radius - margin, 0.0);
  if (!list_.complete_at(path_length)) {
    ++counters.lists_checked;
    const Pose now{grain.position - pose.displacement, grain.rotation};
    if (!still_complete(now, path_length, margin))
      make(grain, wall, now, path_length, margin, counters);
  }
  return std::visit(
      [&](const auto& surface) {
        const Vec3 center = grain.position - pose.displacement;
        return list_.look(path_length, touches, [&](Node& node) {
          ++counters.tested_nodes;
          const double phi = test_node(grain, wall, surface, center, node.node, node.place_body,
                                       node.area, touches);
          return phi < 0 ? check_always : path_length + std::max(phi - margin, 0.0);
        });
      },
      wall.surface);
}

bool NearWall::still_complete(const Pose& pose, double path_length, double margin) {
  if (!list_.exists()) return false;
  const Pose& made = list_.reference();
  const double moved = norm(pose.offset - made.offset) +
                       list_.partner().radius * turn_distance(made.rotation, pose.rotation);
  if (!(moved < list_lifetime * list_.rest())) return false;
  list_.set_complete_until(path_length + (list_.rest() - moved) - margin);
  return true;
}

void NearWall::make(const GrainFrame& grain, const Wall& wall, const Pose& pose, double path_length,
                    double margin, ContactCounters& counters) {
  const ShapeView& shape = *grain.shape;
  const double skin = list_skin(shape);
  double rest = check_never;
  struct Found {
    Node node;
    double next_check;
  };
  thread_local std::vector<Found> found;
  found.clear();
  std::visit(
      [&](const auto& surface) {
        const auto clearance = [&](const Vec3& place_body) {
          return surface.distance(pose.offset + pose.rotation * place_body) - margin;
        };
        for (const NodeCluster& cluster : shape.clusters) {
          const double bound = clearance(cluster.center_body) - cluster.radius;
          if (bound > skin) {
            rest = std::min(rest, bound);
            continue;
          }
          for (NodeIndex n = cluster.first; n < cluster.first + cluster.count; ++n) {
            ++counters.searched_nodes;
            const double node_bound = clearance(shape.nodes.position(n));
            if (node_bound > skin) {
              rest = std::min(rest, node_bound);
              continue;
            }
            found.push_back({{shape.nodes.position(n), shape.nodes.area[n], n},
                             path_length + std::max(node_bound, 0.0)});
          }
        }
      },
      wall.surface);
  ++counters.lists_made;
  counters.listed_nodes += found.size();
  list_.restart({shape.bounding_radius}, pose, path_length, rest, found.size());
  for (std::size_t n = 0; n < found.size(); ++n)
    list_.set_node(n, found[n].node, found[n].next_check);
}

}  // namespace reckon
