// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/near_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "reckon/contact/clearance.hpp"
#include "reckon/contact/displacement_bound.hpp"
#include "reckon/contact/sphere_contact.hpp"

namespace reckon {
namespace {

/// Taken off every clearance: far more than the rounding of positions in the slave's frame, of phi
/// and of the Lipschitz constant, and than that of sums with the path_length.
double rounding_margin(double both_radii, double path_length) {
  return 1e-12 * both_radii + 8 * std::numeric_limits<double>::epsilon() * path_length;
}

/// The bound of a cluster whose nodes have been looked at one by one.
constexpr float opened = std::numeric_limits<float>::infinity();

float single(double number) { return static_cast<float>(number); }

/// Clusters as a filter takes them.
struct ClusterSpheres {
  std::vector<float> x, y, z, radius;

  void copy(std::span<const NodeCluster> clusters, double cells_per_metre) {
    for (auto* const values : {&x, &y, &z, &radius}) values->resize(clusters.size());
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      x[c] = single(clusters[c].center_body.x);
      y[c] = single(clusters[c].center_body.y);
      z[c] = single(clusters[c].center_body.z);
      radius[c] = single(clusters[c].radius * cells_per_metre);
    }
  }
  [[nodiscard]] FilterPoints points() const {
    return {x.data(), y.data(), z.data(), radius.data(), x.size()};
  }
};

}  // namespace

double NearList::find_touches(const GrainFrame& master, const GrainFrame& slave, double path_length,
                              PointFilter filter, std::vector<Touch>& touches,
                              ContactCounters& counters) {
  const double both_radii = list_.exists()
                                ? list_.partner().both_radii
                                : master.shape->bounding_radius + slave.shape->bounding_radius;
  const double margin = rounding_margin(both_radii, path_length);
  if (are_spheres(master, slave)) {
    const double gap = touch_spheres(master, slave, touches);
    return gap < 0 ? check_always : path_length + std::max(gap - margin, 0.0);
  }
  list_.prefetch_next_checks(path_length);
  const Vec3 offset_world = master.position - slave.position;
  if (!spheres_meet(offset_world, both_radii)) {
    return path_length + std::max(norm(offset_world) - both_radii - margin, 0.0);
  }
  const RelativePose at = relative_pose(master, slave);
  if (!list_.complete_at(path_length)) {
    ++counters.lists_checked;
    if (!still_complete(at, master.shape->bounding_radius, path_length, margin)) {
      make(*master.shape, *slave.shape, at, path_length, margin, filter, counters);
    }
  }
  const Slave& other = list_.partner();
  return list_.look(path_length, touches, [&](Node& node) {
    ++counters.tested_nodes;
    const auto next_check_after = [&](double clearance) {
      return path_length + std::max(clearance - margin, 0.0);
    };
    const Vec3 point = at.turn * node.place_body + at.shift;
    if (!(squared_norm(point) < other.radius_squared)) {
      return next_check_after(norm(point) - slave.shape->bounding_radius);
    }
    const auto where = other.grid.locate(point);
    if (!where.inside) return next_check_after(Clearance{*slave.shape}.of_grid(point));
    if (where.i != node.i || where.j != node.j || where.k != node.k) {
      ++counters.cells_read;
      node.i = where.i;
      node.j = where.j;
      node.k = where.k;
      node.cell = other.grid.polynomial(where.i, where.j, where.k);
    }
    const double phi = node.cell.value(where.x, where.y, where.z);
    if (!(phi < 0)) return next_check_after(phi * other.slope);
    const Vec3 gradient_body =
        other.grid.inverse_spacing * node.cell.gradient(where.x, where.y, where.z);
    touches.push_back({node.node, phi, slave.rotation * gradient_body,
                       master.rotation * node.place_body, node.area});
    return check_always;
  });
}

bool NearList::still_complete(const RelativePose& at, double master_radius, double path_length,
                              double margin) {
  if (!list_.exists()) return false;
  const RelativePose& made = list_.reference();
  const double moved =
      norm(at.shift - made.shift) + master_radius * turn_distance(made.turn, at.turn);
  if (!(moved < list_lifetime * list_.rest())) return false;
  list_.set_complete_until(path_length + (list_.rest() - moved) - margin);
  return true;
}

void NearList::make(const ShapeView& master, const ShapeView& slave, const RelativePose& at,
                    double path_length, double margin, PointFilter filter,
                    ContactCounters& counters) {
  struct Found {
    NodeIndex node;
    double clearance;
  };
  // Scratch of this thread. A cluster's bound: no node of it has less clearance.
  thread_local std::vector<Found> found;
  thread_local ClusterSpheres clusters;
  thread_local std::vector<float> bounds;
  found.clear();
  bounds.resize(master.clusters.size());
  const double skin = list_skin(master);
  const FilterTarget target{slave, at, master.bounding_radius, skin};
  clusters.copy(master.clusters, target.inverse_spacing);
  const auto metres = [&](float bound) { return target.in_metres(bound) - margin; };
  double rest = check_never;
  const auto open = [&](const NodeCluster& cluster) {
    std::array<float, nodes_per_cluster> x{};
    std::array<float, nodes_per_cluster> y{};
    std::array<float, nodes_per_cluster> z{};
    std::array<float, nodes_per_cluster> bound{};
    for (NodeIndex first = cluster.first; first < cluster.first + cluster.count;
         first += nodes_per_cluster) {
      const std::size_t count = std::min(nodes_per_cluster, cluster.first + cluster.count - first);
      for (std::size_t n = 0; n < count; ++n) {
        x[n] = single(master.nodes.x[first + n]);
        y[n] = single(master.nodes.y[first + n]);
        z[n] = single(master.nodes.z[first + n]);
      }
      filter(target, {x.data(), y.data(), z.data(), nullptr, count}, bound.data());
      counters.searched_nodes += count;
      for (NodeIndex n = 0; n < count; ++n) {
        const double clearance = metres(bound[n]);
        if (clearance <= skin) {
          found.push_back({first + n, clearance});
        } else {
          rest = std::min(rest, clearance);
        }
      }
    }
  };
  filter(target, clusters.points(), bounds.data());
  for (std::size_t c = 0; c < bounds.size(); ++c) {
    if (metres(bounds[c]) > skin) continue;
    open(master.clusters[c]);
    bounds[c] = opened;
  }
  // Nothing near: the pair will be skipped, the longer the better the bound is known.
  while (found.empty()) {
    const auto nearest = std::min_element(bounds.begin(), bounds.end());
    if (nearest == bounds.end() || metres(*nearest) >= rest) break;
    *nearest = opened;
    open(master.clusters[static_cast<std::size_t>(nearest - bounds.begin())]);
  }
  if (!bounds.empty())
    rest = std::min(rest, metres(*std::min_element(bounds.begin(), bounds.end())));
  ++counters.lists_made;
  counters.listed_nodes += found.size();

  list_.restart({.both_radii = master.bounding_radius + slave.bounding_radius,
                 .radius_squared = slave.bounding_radius * slave.bounding_radius,
                 .slope = slave.lipschitz > 0 ? 1 / slave.lipschitz : 0,
                 .grid = slave.level_set},
                at, path_length, rest, found.size());
  for (std::size_t n = 0; n < found.size(); ++n) {
    const NodeIndex node = found[n].node;
    list_.set_node(
        n,
        {.place_body = master.nodes.position(node), .area = master.nodes.area[node], .node = node},
        path_length + std::max(found[n].clearance, 0.0));
  }
}

}  // namespace reckon
