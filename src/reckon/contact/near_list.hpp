// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "reckon/contact/clearance.hpp"
#include "reckon/contact/contact_counters.hpp"
#include "reckon/contact/near_skin.hpp"
#include "reckon/contact/point_filter.hpp"
#include "reckon/contact/relative_pose.hpp"
#include "reckon/contact/touch.hpp"
#include "reckon/contact/verlet_node_list.hpp"

namespace reckon {

/// Taken off every clearance: far more than the rounding of positions in the slave's frame, of phi
/// and of the Lipschitz constant, and than that of sums with the path_length.
[[nodiscard]] double rounding_margin(double both_radii, double path_length);

/// A node of a master near a slave, with the coefficients of the cell of the slave's grid in which
/// it was seen last: the grid is read only when it enters another.
struct alignas(64) NearNode {
  Vec3 place_body;      // in the master [m]
  double area{0};       // [m^2]
  CellPolynomial cell;  // of the cell (i, j, k)
  std::int32_t i{-1};   // -1: no cell yet
  std::int32_t j{0};
  std::int32_t k{0};
  NodeIndex node{0};
};

/// What a test of a node reads of the slave's shape.
struct NodeTarget {
  double radius_squared{0};  // bounding [m^2]
  double slope{0};           // 1 / Lipschitz constant of the grid, or 0 [1]
  LevelSetView grid;

  NodeTarget() = default;
  explicit NodeTarget(const ShapeView& slave)
      : radius_squared{slave.bounding_radius * slave.bounding_radius},
        slope{slave.lipschitz > 0 ? 1 / slave.lipschitz : 0},
        grid{slave.level_set} {}
};

/// Whether one node touches, with the bits of the plain finder. Writes the touch, if it does, and
/// the node's cell.
struct NodeTest {
  const GrainFrame& master;
  const GrainFrame& slave;
  RelativePose at;
  double margin;  ///< see rounding_margin [m]

  NodeTest(const GrainFrame& master_frame, const GrainFrame& slave_frame, double rounding)
      : master{master_frame},
        slave{slave_frame},
        at{relative_pose(master_frame, slave_frame)},
        margin{rounding} {}
  /// How far both sides must travel before the node can touch, or minus infinity if it touches [m].
  double operator()(const NodeTarget& target, NearNode& node, Touch& touch,
                    ContactCounters& counters) const {
    ++counters.tested_nodes;
    const auto after = [&](double clearance) { return std::max(clearance - margin, 0.0); };
    const Vec3 point = at.turn * node.place_body + at.shift;
    if (!(squared_norm(point) < target.radius_squared)) {
      return after(norm(point) - slave.shape->bounding_radius);
    }
    const auto where = target.grid.locate(point);
    if (!where.inside) return after(Clearance{*slave.shape}.of_grid(point));
    if (where.i != node.i || where.j != node.j || where.k != node.k) {
      ++counters.cells_read;
      node.i = where.i;
      node.j = where.j;
      node.k = where.k;
      node.cell = target.grid.polynomial(where.i, where.j, where.k);
    }
    const double phi = node.cell.value(where.x, where.y, where.z);
    if (!(phi < 0)) return after(phi * target.slope);
    const Vec3 gradient_body =
        target.grid.inverse_spacing * node.cell.gradient(where.x, where.y, where.z);
    touch = {node.node, phi, slave.rotation * gradient_body, master.rotation * node.place_body,
             node.area};
    return check_always;
  }
};

/// The nodes of one master that are near one slave and do not touch it: a VerletNodeList. Nodes
/// that touch are kept elsewhere (PairLanes) until they let go.
///
/// When the path length passes the mark until which the list is complete, both grains may have
/// moved together, or there and back. So the motion of master against slave since the list was made
/// is looked at first; only if that has used up most of the list's allowance is it made anew.
class NearList {
 public:
  struct Found {
    Touch touch;
    NearNode node;
  };

  /// Appends the nodes that touch now and are none of `touching`, which is in node order. Returns
  /// the path length before which no other node can touch. Spheres need no list. Any `filter` will
  /// do.
  double find_touches(const GrainFrame& master, const GrainFrame& slave, double path_length,
                      PointFilter filter, std::span<const NodeIndex> touching,
                      std::vector<Found>& found, ContactCounters& counters);

  /// A node that touched lets go. It cannot touch before the path_length reads `next_check`.
  void take_back(const NearNode& node, double next_check) { list_.take_back(node, next_check); }

  /// Asks the memory for the head of the list, and later for what a search at this path length
  /// reads behind it.
  void prefetch() const { list_.prefetch_head(); }
  void prefetch_next_checks(double path_length) const { list_.prefetch_next_checks(path_length); }
  /// Memory held, besides the object.
  [[nodiscard]] std::size_t bytes() const { return list_.bytes(); }

 private:
  struct Slave {
    double both_radii{0};  // bounding radii, master's plus slave's [m]
    NodeTarget target;
  };

  [[nodiscard]] bool still_complete(const RelativePose& at, double master_radius,
                                    double path_length, double margin);
  void make(const ShapeView& master, const ShapeView& slave, const RelativePose& at,
            double path_length, double margin, PointFilter filter,
            std::span<const NodeIndex> touching, ContactCounters& counters);

  VerletNodeList<Slave, RelativePose, NearNode> list_;
};

}  // namespace reckon
