// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// A cylinder between two planes across its axis.
struct CylinderPlace {
  Vec3 foot;  ///< where the axis meets the lower plane [m]
  Vec3 axis_unit;
  double radius{0};  ///< [m]
  double height{0};  ///< [m]

  friend bool operator==(const CylinderPlace&, const CylinderPlace&) = default;
};

/// Nodes on a cylinder in rings from end to end, each ring turned by half a spacing against the one
/// below, so that neighbours form nearly equal-sided triangles. Node = ring * columns + column.
class MembraneMesh {
 public:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  MembraneMesh() = default;
  /// As near to `spacing` [m] as whole numbers of nodes allow; at least 6 columns and 3 rings.
  MembraneMesh(const CylinderPlace& place, double spacing);
  /// About how many nodes that makes.
  [[nodiscard]] static double expected_size(const CylinderPlace& place, double spacing);

  [[nodiscard]] std::uint32_t rings() const { return rings_; }
  [[nodiscard]] std::uint32_t columns() const { return columns_; }
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  /// Where nodes are at the start [m].
  [[nodiscard]] const std::vector<Vec3>& places() const { return places_; }
  [[nodiscard]] bool is_end(std::uint32_t node) const {
    return node < columns_ || node >= columns_ * (rings_ - 1);
  }
  /// A third of the triangles around the node, at the start [m^2].
  [[nodiscard]] double area(std::uint32_t node) const { return is_end(node) ? 0.5 * area_ : area_; }

  /// The six neighbours of a node, counter-clockwise seen from outside, from the next one in its
  /// ring on; `none` beyond an end. The first and the fourth are in the same ring, and the second
  /// and third in the next one.
  [[nodiscard]] std::array<std::uint32_t, 6> neighbors(std::uint32_t node) const;

  [[nodiscard]] double ring_bond() const { return ring_bond_; }    ///< length at rest [m]
  [[nodiscard]] double cross_bond() const { return cross_bond_; }  ///< between rings [m]

 private:
  std::uint32_t rings_{0};
  std::uint32_t columns_{0};
  double ring_bond_{0};
  double cross_bond_{0};
  double area_{0};
  std::vector<Vec3> places_;
};

}  // namespace reckon
