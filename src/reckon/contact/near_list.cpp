// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/near_list.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "reckon/contact/clearance.hpp"
#include "reckon/contact/motion_meter.hpp"
#include "reckon/contact/near_skin.hpp"

namespace reckon {
namespace {

/// Taken off every clearance: far more than the rounding of positions in the slave's frame, of phi
/// and of the Lipschitz constant, and than that of sums with the odometer.
double rounding_margin(double both_radii, double odometer) {
  return 1e-12 * both_radii + 8 * std::numeric_limits<double>::epsilon() * odometer;
}

void prefetch_line(const void* address) { __builtin_prefetch(address); }

}  // namespace

double NearList::find_touches(const GrainFrame& master, const GrainFrame& slave, double odometer,
                              std::vector<Touch>& touches, ContactCounters& counters) {
  const double both_radii = block_ ? block_->master_radius + block_->slave_radius
                                   : master.shape->bounding_radius + slave.shape->bounding_radius;
  const double margin = rounding_margin(both_radii, odometer);
  const Vec3 offset_world = master.position - slave.position;
  if (!spheres_meet(offset_world, both_radii)) {
    return odometer + std::max(norm(offset_world) - both_radii - margin, 0.0);
  }
  const Placement at = place(master, slave);
  if (!block_ || !(odometer < block_->complete_until)) {
    ++counters.lists_checked;
    if (!block_ || !still_complete(at, odometer, margin)) {
      make(*master.shape, *slave.shape, at, odometer, margin, counters);
    }
  }
  Head& head = *block_;
  Node* const node = nodes();
  bool changed = false;
  for (std::uint32_t n = 0; n < head.touching; ++n) {
    changed |= !test(node[n], at, master, slave, odometer, margin, touches, counters);
  }
  if (!(odometer < head.next_wake)) {
    head.next_wake = wake_never;
    for (std::uint32_t n = head.touching; n < head.count; ++n) {
      if (!(odometer < node[n].wake) &&
          test(node[n], at, master, slave, odometer, margin, touches, counters)) {
        changed = true;
      } else {
        head.next_wake = std::min(head.next_wake, node[n].wake);
      }
    }
  }
  if (changed) regroup(touches);
  return head.touching > 0 ? wake_always : std::min(head.next_wake, head.complete_until);
}

/// Looks one node up. Touching, it is handed on; else it is told when to wake.
inline bool NearList::test(Node& node, const Placement& at, const GrainFrame& master,
                           const GrainFrame& slave, double odometer, double margin,
                           std::vector<Touch>& touches, ContactCounters& counters) {
  const Head& head = *block_;
  const LevelSetView& grid = head.slave_grid;
  ++counters.tested_nodes;
  const auto sleep = [&](double clearance) {
    node.wake = odometer + std::max(clearance - margin, 0.0);
    return false;
  };
  const Vec3 point = at.turn * node.place_body + at.shift;
  if (!(squared_norm(point) < head.slave_radius * head.slave_radius)) {
    return sleep(norm(point) - head.slave_radius);
  }
  const auto where = grid.locate(point);
  if (!where.inside) return sleep(Clearance{*slave.shape}.of_grid(point));
  if (where.i != node.i || where.j != node.j || where.k != node.k) {
    ++counters.cells_read;
    node.i = where.i;
    node.j = where.j;
    node.k = where.k;
    node.cell = grid.polynomial(where.i, where.j, where.k);
  }
  const double phi = node.cell.value(where.x, where.y, where.z);
  if (!(phi < 0)) return sleep(phi * head.slave_slope);
  node.wake = wake_always;
  const Vec3 gradient_body = node.cell.gradient(where.x, where.y, where.z) / grid.spacing;
  touches.push_back({node.node, phi, slave.rotation * gradient_body,
                     master.rotation * node.place_body, node.area});
  return true;
}

/// Touching nodes to the front, and everything in node order.
void NearList::regroup(std::vector<Touch>& touches) {
  Head& head = *block_;
  Node* const node = nodes();
  const auto touches_now = [](const Node& n) { return n.wake == wake_always; };
  std::sort(node, node + head.count, [&](const Node& a, const Node& b) {
    return touches_now(a) != touches_now(b) ? touches_now(a) : a.node < b.node;
  });
  const Node* const first_other = std::partition_point(node, node + head.count, touches_now);
  head.touching = static_cast<std::uint32_t>(first_other - node);
  for (const Node* other = first_other; other != node + head.count; ++other) {
    head.next_wake = std::min(head.next_wake, other->wake);
  }
  std::sort(touches.begin(), touches.end(),
            [](const Touch& a, const Touch& b) { return a.node < b.node; });
}

bool NearList::still_complete(const Placement& at, double odometer, double margin) {
  Head& head = *block_;
  const double moved =
      norm(at.shift - head.shift) + head.master_radius * turn_distance(head.turn, at.turn);
  if (!(moved < list_lifetime * head.rest)) return false;
  head.complete_until = odometer + (head.rest - moved) - margin;
  return true;
}

void NearList::make(const ShapeView& master, const ShapeView& slave, const Placement& at,
                    double odometer, double margin, ContactCounters& counters) {
  struct Found {
    NodeIndex node;
    double clearance;
  };
  // Scratch of this thread. A cluster's bound: no node of it has less clearance.
  thread_local std::vector<Found> found;
  thread_local std::vector<double> bounds;
  found.clear();
  bounds.clear();
  const double skin = list_skin(master);
  const Clearance clearance{slave};
  double rest = wake_never;
  const auto open = [&](const NodeCluster& cluster) {
    for (NodeIndex n = cluster.first; n < cluster.first + cluster.count; ++n) {
      ++counters.searched_nodes;
      const Vec3 point = at.turn * master.node(n) + at.shift;
      double bound = clearance.of_sphere(point) - margin;
      if (bound <= skin) bound = std::max(bound, clearance.of_grid(point) - margin);
      if (bound <= skin) {
        found.push_back({n, bound});
      } else {
        rest = std::min(rest, bound);
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
  while (found.empty()) {
    const auto nearest = std::min_element(bounds.begin(), bounds.end());
    if (nearest == bounds.end() || *nearest >= rest) break;
    *nearest = wake_never;
    open(master.clusters[static_cast<std::size_t>(nearest - bounds.begin())]);
  }
  for (const double bound : bounds) rest = std::min(rest, bound);
  ++counters.lists_made;
  counters.listed_nodes += found.size();

  reserve(static_cast<std::uint32_t>(found.size()));
  Head& head = *block_;
  head.complete_until = odometer + rest;
  head.next_wake = odometer;
  head.touching = 0;
  head.count = static_cast<std::uint32_t>(found.size());
  head.master_radius = master.bounding_radius;
  head.slave_radius = slave.bounding_radius;
  head.slave_slope = slave.lipschitz > 0 ? 1 / slave.lipschitz : 0;
  head.slave_grid = slave.level_set;
  head.rest = rest;
  head.turn = at.turn;
  head.shift = at.shift;
  Node* node = nodes();
  for (const Found& near : found) {
    *node++ = {.place_body = master.node(near.node),
               .area = master.node_area[near.node],
               .wake = odometer + std::max(near.clearance, 0.0),
               .node = near.node};
  }
}

void NearList::prefetch() const {
  if (!block_) return;
  const auto* const line = reinterpret_cast<const std::byte*>(block_.get());
  prefetch_line(line);
  prefetch_line(line + 64);
  for (std::size_t n = 0; n < 4; ++n) {
    prefetch_line(line + sizeof(Head) + 64 * n);
  }
}

void NearList::FreeBlock::operator()(Head* head) const {
  ::operator delete (head, std::align_val_t{alignof(Head)});
}

NearList::Node* NearList::nodes() const {
  return std::launder(reinterpret_cast<Node*>(block_.get() + 1));
}

/// Makes room for nodes; what the block held is lost if it must grow.
void NearList::reserve(std::uint32_t count) {
  if (block_ && block_->capacity >= count) return;
  const std::uint32_t capacity = (count + 3) / 4 * 4;
  void* const memory =
      ::operator new (sizeof(Head) + capacity * sizeof(Node), std::align_val_t{alignof(Head)});
  block_.reset(new (memory) Head{.capacity = capacity});
  for (std::uint32_t n = 0; n < capacity; ++n) new (nodes() + n) Node{};
}

}  // namespace reckon
