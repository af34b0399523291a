// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/near_wall.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reckon/contact/motion_meter.hpp"
#include "reckon/contact/near_skin.hpp"

namespace reckon {
namespace {

/// Far more than the rounding of places and distances, walls being at most so far from the origin.
double rounding_margin(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                       double odometer) {
  const double size = std::visit(
      [&](const auto& surface) {
        const Vec3 from_wall = grain.position - pose.displacement - surface.point;
        return norm(grain.position) + norm(pose.displacement) + norm(from_wall);
      },
      wall.surface);
  return 1e-12 * grain.shape->bounding_radius +
         32 * std::numeric_limits<double>::epsilon() * (odometer + size);
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

}  // namespace

double distance(const Wall& wall, const WallPose& pose, const Vec3& point) {
  return std::visit([&](const auto& s) { return s.distance(point - pose.displacement); },
                    wall.surface);
}

void find_wall_touches(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                       std::vector<Touch>& touches) {
  const ShapeView& shape = *grain.shape;
  if (!(distance(wall, pose, grain.position) < shape.bounding_radius)) return;
  std::visit(
      [&](const auto& surface) {
        const Vec3 center = grain.position - pose.displacement;
        for (NodeIndex n = 0; n < shape.node_x.size(); ++n) {
          test_node(grain, wall, surface, center, n, shape.node(n), shape.node_area[n], touches);
        }
      },
      wall.surface);
}

double NearWall::find_touches(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                              double odometer, std::vector<Touch>& touches,
                              ContactCounters& counters) {
  const double margin = rounding_margin(grain, wall, pose, odometer);
  const double from_center = distance(wall, pose, grain.position);
  if (!(from_center < grain.shape->bounding_radius)) {
    return odometer + std::max(from_center - grain.shape->bounding_radius - margin, 0.0);
  }
  if (!(odometer < complete_until_)) {
    ++counters.lists_checked;
    if (!still_complete(grain, pose, odometer, margin)) {
      make(grain, wall, pose, odometer, margin, counters);
    }
  }
  double earliest = complete_until_;
  std::visit(
      [&](const auto& surface) {
        const Vec3 center = grain.position - pose.displacement;
        for (std::size_t n = 0; n < nodes_.size(); ++n) {
          if (!(odometer < wake_[n])) {
            ++counters.tested_nodes;
            const Node& node = nodes_[n];
            const double phi = test_node(grain, wall, surface, center, node.node, node.place_body,
                                         node.area, touches);
            wake_[n] = phi < 0 ? wake_always : odometer + std::max(phi - margin, 0.0);
          }
          earliest = std::min(earliest, wake_[n]);
        }
      },
      wall.surface);
  return earliest;
}

bool NearWall::still_complete(const GrainFrame& grain, const WallPose& pose, double odometer,
                              double margin) {
  if (rest_ < 0) return false;
  const double moved =
      norm(grain.position - pose.displacement - offset_when_made_) +
      grain.shape->bounding_radius * turn_distance(rotation_when_made_, grain.rotation);
  if (!(moved < list_lifetime * rest_)) return false;
  complete_until_ = odometer + (rest_ - moved) - margin;
  return true;
}

void NearWall::make(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                    double odometer, double margin, ContactCounters& counters) {
  const ShapeView& shape = *grain.shape;
  const double skin = list_skin(shape);
  ++counters.lists_made;
  wake_.clear();
  nodes_.clear();
  rest_ = wake_never;
  std::visit(
      [&](const auto& surface) {
        const Vec3 center = grain.position - pose.displacement;
        const auto clearance = [&](const Vec3& place_body) {
          return surface.distance(center + grain.rotation * place_body) - margin;
        };
        for (const NodeCluster& cluster : shape.clusters) {
          const double bound = clearance(cluster.center_body) - cluster.radius;
          if (bound > skin) {
            rest_ = std::min(rest_, bound);
            continue;
          }
          for (NodeIndex n = cluster.first; n < cluster.first + cluster.count; ++n) {
            ++counters.searched_nodes;
            const double node_bound = clearance(shape.node(n));
            if (node_bound > skin) {
              rest_ = std::min(rest_, node_bound);
              continue;
            }
            wake_.push_back(odometer + std::max(node_bound, 0.0));
            nodes_.push_back({shape.node(n), shape.node_area[n], n});
          }
        }
      },
      wall.surface);
  counters.listed_nodes += nodes_.size();
  offset_when_made_ = grain.position - pose.displacement;
  rotation_when_made_ = grain.rotation;
  complete_until_ = odometer + rest_;
}

}  // namespace reckon
