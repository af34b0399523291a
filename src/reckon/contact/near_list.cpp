// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/near_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "reckon/contact/clearance.hpp"
#include "reckon/contact/displacement_bound.hpp"

namespace reckon {
namespace {

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

double rounding_margin(double both_radii, double path_length) {
  return 1e-12 * both_radii + 8 * std::numeric_limits<double>::epsilon() * path_length;
}

double NearList::find_touches(const GrainFrame& master, const GrainFrame& slave, double path_length,
                              PointFilter filter, std::span<const NodeIndex> touching,
                              std::vector<Found>& found, ContactCounters& counters) {
  const double both_radii = list_.exists()
                                ? list_.partner().both_radii
                                : master.shape->bounding_radius + slave.shape->bounding_radius;
  const double margin = rounding_margin(both_radii, path_length);
  const Vec3 offset_world = master.position - slave.position;
  if (!spheres_meet(offset_world, both_radii)) {
    return path_length + std::max(norm(offset_world) - both_radii - margin, 0.0);
  }
  const NodeTest test{master, slave, margin};
  if (!list_.complete_at(path_length)) {
    ++counters.lists_checked;
    if (!still_complete(test.at, master.shape->bounding_radius, path_length, margin)) {
      make(*master.shape, *slave.shape, test.at, path_length, margin, filter, touching, counters);
    }
  }
  const NodeTarget& target = list_.partner().target;
  return list_.look_at_others(path_length, [&](NearNode& node) {
    Touch touch;
    const double clearance = test(target, node, touch, counters);
    if (clearance != check_always) return path_length + clearance;
    found.push_back({touch, node});
    return check_never;
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
                    std::span<const NodeIndex> touching, ContactCounters& counters) {
  struct Near {
    NodeIndex node;
    double clearance;
  };
  // Scratch of this thread. A cluster's bound: no node of it has less clearance.
  thread_local std::vector<Near> found;
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

  list_.restart({master.bounding_radius + slave.bounding_radius, NodeTarget{slave}}, at,
                path_length, rest, found.size());
  auto touches = touching.begin();
  for (std::size_t n = 0; n < found.size(); ++n) {
    const NodeIndex node = found[n].node;
    while (touches != touching.end() && *touches < node) ++touches;
    const bool is_touching = touches != touching.end() && *touches == node;
    list_.set_node(
        n,
        {.place_body = master.nodes.position(node), .area = master.nodes.area[node], .node = node},
        is_touching ? check_never : path_length + std::max(found[n].clearance, 0.0));
  }
}

}  // namespace reckon
