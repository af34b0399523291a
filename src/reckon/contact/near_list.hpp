// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "reckon/contact/contact_counters.hpp"
#include "reckon/contact/point_filter.hpp"
#include "reckon/contact/relative_pose.hpp"
#include "reckon/contact/touch.hpp"
#include "reckon/contact/verlet_node_list.hpp"

namespace reckon {

/// The nodes of one master that are near one slave: a VerletNodeList. A node keeps the coefficients
/// of the cell that it was last seen in, so the slave's grid is read only when it enters another.
///
/// When the path length passes the mark until which the list is complete, both grains may have
/// moved together, or there and back. So the motion of master against slave since the list was made
/// is looked at first; only if that has used up most of the list's allowance is it made anew.
class NearList {
 public:
  /// Appends the touching nodes in node order: the same bits as the plain finder's. Returns the
  /// path length before which no node can touch, or minus infinity if a node touches now.
  /// Any `filter` will do.
  double find_touches(const GrainFrame& master, const GrainFrame& slave, double path_length,
                      PointFilter filter, std::vector<Touch>& touches, ContactCounters& counters);

  void prefetch() const { list_.prefetch(); }
  /// Memory held, besides the object.
  [[nodiscard]] std::size_t bytes() const { return list_.bytes(); }

 private:
  struct Slave {
    double both_radii{0};      // bounding radii, master's plus slave's [m]
    double radius_squared{0};  // bounding, of the slave [m^2]
    double slope{0};           // 1 / Lipschitz constant
    LevelSetView grid;
  };
  struct alignas(64) Node {
    Vec3 place_body;      // in the master [m]
    double area{0};       // [m^2]
    CellPolynomial cell;  // of the cell (i, j, k)
    std::int32_t i{-1};   // -1: no cell yet
    std::int32_t j{0};
    std::int32_t k{0};
    NodeIndex node{0};
  };

  [[nodiscard]] bool still_complete(const RelativePose& at, double master_radius,
                                    double path_length, double margin);
  void make(const ShapeView& master, const ShapeView& slave, const RelativePose& at,
            double path_length, double margin, PointFilter filter, ContactCounters& counters);

  VerletNodeList<Slave, RelativePose, Node> list_;
};

}  // namespace reckon
