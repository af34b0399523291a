// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
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
///
/// A step on a resting contact reads nothing but one block of memory, from its start. Touching
/// nodes come first, so the block is read no further than them:
///
///   | head: marks, slave's grid | head: when made | touching nodes by index | others by index |
///   0                          128               256        + 128 each
///
/// A node keeps the eight coefficients of the cell that it was last seen in: the slave's grid is
/// read only when a node enters another cell.
class NearList {
 public:
  /// Appends the touching nodes in node order: the same bits as the plain finder's. Returns the
  /// odometer reading before which no node can touch, or minus infinity if a node touches now.
  double find_touches(const GrainFrame& master, const GrainFrame& slave, double odometer,
                      std::vector<Touch>& touches, ContactCounters& counters);

  /// Asks the memory for what the next find_touches reads.
  void prefetch() const;

  /// Forgets everything.
  void clear() { block_.reset(); }

 private:
  struct alignas(64) Head {
    double complete_until{0};   // odometer reading
    double next_wake{0};        // the earliest of the nodes that do not touch: odometer reading
    std::uint32_t touching{0};  // nodes at the front
    std::uint32_t count{0};     // nodes
    std::uint32_t capacity{0};  // nodes
    double master_radius{0};    // bounding [m]
    double slave_radius{0};     // bounding [m]
    double slave_slope{0};      // 1 / Lipschitz constant
    LevelSetView slave_grid;
    double rest{0};  // clearance of all nodes but the listed, when made [m]
    Mat3 turn;       // when made
    Vec3 shift;      // when made
  };
  struct alignas(64) Node {
    Vec3 place_body;      ///< in the master [m]
    double area{0};       ///< [m^2]
    CellPolynomial cell;  ///< of the cell (i, j, k)
    double wake{0};       ///< odometer reading
    std::int32_t i{-1};   ///< -1: no cell yet
    std::int32_t j{0};
    std::int32_t k{0};
    NodeIndex node{0};
  };
  struct FreeBlock {
    void operator()(Head* head) const;
  };

  [[nodiscard]] Node* nodes() const;
  void reserve(std::uint32_t count);
  [[nodiscard]] bool still_complete(const Placement& at, double odometer, double margin);
  void make(const ShapeView& master, const ShapeView& slave, const Placement& at, double odometer,
            double margin, ContactCounters& counters);
  [[nodiscard]] bool test(Node& node, const Placement& at, const GrainFrame& master,
                          const GrainFrame& slave, double odometer, double margin,
                          std::vector<Touch>& touches, ContactCounters& counters);
  void regroup(std::vector<Touch>& touches);

  std::unique_ptr<Head, FreeBlock> block_;  // the head, then the nodes
};

}  // namespace reckon
