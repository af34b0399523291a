// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "reckon/contact/contact_counters.hpp"
#include "reckon/contact/placement.hpp"
#include "reckon/contact/touch.hpp"

namespace reckon {

/// The nodes of one master that are near one slave, and when each must be looked at again.
///
/// Time is measured in motion: `odometer` is the sum of what both grains have travelled
/// (MotionMeter). A node whose clearance was d when the odometer stood at m cannot touch before it
/// stands at m + d: that is the node's wake-up. Nodes that are not in the list are all farther than
/// `rest`, so the list as a whole is good until the odometer passes m + rest.
///
///       phi                                  list        wakes at
///        |   . . . . . . . . rest . . .      node  17    m + 0.020
///        |      o      o                     node  18    always: it touches
///   -----+--------x------x--------------     node  19    always: it touches
///        |           x                       node  23    m + 0.011
///
/// When the odometer passes that mark, both grains may have moved together, or there and back. So
/// the motion of master against slave since the list was made is looked at first; only if that has
/// used up most of `rest` is the list made anew.
class NearList {
 public:
  /// Appends the touching nodes in node order: the same bits as the plain finder's. Returns the
  /// odometer reading before which no node can touch, or minus infinity if a node touches now.
  double find_touches(const GrainFrame& master, const GrainFrame& slave, double odometer,
                      std::vector<Touch>& touches, ContactCounters& counters);

  /// Forgets everything.
  void clear() { *this = NearList{}; }

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

 private:
  /// A node with the cell of the slave's grid that it was last seen in.
  struct Node {
    Vec3 place_body;      ///< in the master [m]
    double area{0};       ///< [m^2]
    CellPolynomial cell;  ///< of the cell (i, j, k)
    std::int32_t i{-1};   ///< -1: no cell yet
    std::int32_t j{0};
    std::int32_t k{0};
    NodeIndex node{0};
  };

  [[nodiscard]] bool still_complete(const Placement& at, double master_radius, double odometer,
                                    double margin);
  void make(const ShapeView& master, const ShapeView& slave, const Placement& at, double odometer,
            ContactCounters& counters);

  double complete_until_{0};  // odometer reading
  double rest_{-1};           // clearance of all other nodes when made; < 0: not made yet [m]
  Mat3 turn_when_made_;
  Vec3 shift_when_made_;
  std::vector<double> wake_;  // per node of the list: odometer reading
  std::vector<Node> nodes_;   // in node order
};

}  // namespace reckon
