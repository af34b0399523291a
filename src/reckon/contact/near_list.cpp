// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/near_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reckon/contact/clearance.hpp"
#include "reckon/contact/motion_meter.hpp"
#include "reckon/contact/near_skin.hpp"

namespace reckon {
namespace {

/// Taken off every clearance: far more than the rounding of positions in the slave's frame, of phi
/// and of the Lipschitz constant, and than that of sums with the odometer.
double rounding_margin(const ShapeView& master, const ShapeView& slave, double odometer) {
  return 1e-12 * (master.bounding_radius + slave.bounding_radius) +
         8 * std::numeric_limits<double>::epsilon() * odometer;
}

}  // namespace

double NearList::find_touches(const GrainFrame& master, const GrainFrame& slave, double odometer,
                              std::vector<Touch>& touches, ContactCounters& counters) {
  const ShapeView& shape = *master.shape;
  const ShapeView& other = *slave.shape;
  const double margin = rounding_margin(shape, other, odometer);
  const Placement at = place(master, slave);
  if (!spheres_meet(at.offset_world, shape, other)) {
    return odometer +
           std::max(norm(at.offset_world) - shape.bounding_radius - other.bounding_radius - margin,
                    0.0);
  }
  if (!(odometer < complete_until_)) {
    ++counters.lists_checked;
    if (!still_complete(at, shape.bounding_radius, odometer, margin)) {
      make(shape, other, at, odometer, counters);
    }
  }
  const Clearance clearance{other};
  const LevelSetView& grid = other.level_set;
  const double radius_squared = other.bounding_radius * other.bounding_radius;
  double earliest = complete_until_;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (odometer < wake_[n]) {
      earliest = std::min(earliest, wake_[n]);
      continue;
    }
    ++counters.tested_nodes;
    Node& node = nodes_[n];
    const Vec3 point = at.turn * node.place_body + at.shift;
    if (!(squared_norm(point) < radius_squared)) {
      wake_[n] = odometer + std::max(clearance.of_sphere(point) - margin, 0.0);
      earliest = std::min(earliest, wake_[n]);
      continue;
    }
    const auto where = grid.locate(point);
    if (!where.inside) {
      wake_[n] = odometer + std::max(clearance.of_grid(point) - margin, 0.0);
      earliest = std::min(earliest, wake_[n]);
      continue;
    }
    if (where.i != node.i || where.j != node.j || where.k != node.k) {
      ++counters.cells_read;
      node.i = where.i;
      node.j = where.j;
      node.k = where.k;
      node.cell = grid.polynomial(where.i, where.j, where.k);
    }
    const double phi = node.cell.value(where.x, where.y, where.z);
    if (!(phi < 0)) {
      wake_[n] = odometer + std::max(clearance.of_phi(phi) - margin, 0.0);
      earliest = std::min(earliest, wake_[n]);
      continue;
    }
    wake_[n] = wake_always;
    earliest = wake_always;
    const Vec3 gradient_body = node.cell.gradient(where.x, where.y, where.z) / grid.spacing;
    touches.push_back({node.node, phi, slave.rotation * gradient_body,
                       master.rotation * node.place_body, node.area});
  }
  return earliest;
}

bool NearList::still_complete(const Placement& at, double master_radius, double odometer,
                              double margin) {
  if (rest_ < 0) return false;
  const double moved =
      norm(at.shift - shift_when_made_) + master_radius * turn_distance(turn_when_made_, at.turn);
  if (!(moved < list_lifetime * rest_)) return false;
  complete_until_ = odometer + (rest_ - moved) - margin;
  return true;
}

void NearList::make(const ShapeView& master, const ShapeView& slave, const Placement& at,
                    double odometer, ContactCounters& counters) {
  const double margin = rounding_margin(master, slave, odometer);
  const double skin = list_skin(master);
  const Clearance clearance{slave};
  ++counters.lists_made;
  wake_.clear();
  nodes_.clear();
  rest_ = wake_never;

  // A cluster's bound: no node of it has less clearance. Opened clusters leave the contest.
  thread_local std::vector<double> bounds;
  bounds.clear();
  const auto open = [&](const NodeCluster& cluster) {
    for (std::uint32_t n = cluster.first; n < cluster.first + cluster.count; ++n) {
      ++counters.searched_nodes;
      const Vec3 place_body = master.node(n);
      const Vec3 point = at.turn * place_body + at.shift;
      double bound = clearance.of_sphere(point) - margin;
      if (bound <= skin) bound = std::max(bound, clearance.of_grid(point) - margin);
      if (bound <= skin) {
        wake_.push_back(odometer + std::max(bound, 0.0));
        nodes_.push_back({.place_body = place_body, .area = master.node_area[n], .node = n});
      } else {
        rest_ = std::min(rest_, bound);
      }
    }
  };
  for (const NodeCluster& cluster : master.clusters) {
    const Vec3 center = at.turn * cluster.center_body + at.shift;
    double bound = clearance.of_sphere(center) - cluster.radius - margin;
    if (bound <= skin) bound = std::max(bound, clearance.of_grid(center) - cluster.radius - margin);
    if (bound <= skin) {
      open(cluster);
      bound = wake_never;
    }
    bounds.push_back(bound);
  }
  // Nothing near: the pair will sleep, the longer the better the bound is known.
  while (nodes_.empty()) {
    const auto nearest = std::min_element(bounds.begin(), bounds.end());
    if (nearest == bounds.end() || *nearest >= rest_) break;
    *nearest = wake_never;
    open(master.clusters[static_cast<std::size_t>(nearest - bounds.begin())]);
  }
  for (const double bound : bounds) rest_ = std::min(rest_, bound);

  counters.listed_nodes += nodes_.size();
  turn_when_made_ = at.turn;
  shift_when_made_ = at.shift;
  complete_until_ = odometer + rest_;
}

}  // namespace reckon
