// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "reckon/boundary/membrane.hpp"

namespace reckon {

/// On which side of a membrane, as it stands now, a point is. A line from the point away from the
/// axis leaves the membrane once more than it enters where the point is inside:
///
///    axis     membrane
///     |  p- - - -(- ->       crossed once: inside
///     |          (  p- - ->  never: outside
///
/// Triangles are kept in bins of angle and height, so that a line meets few of them.
class MembraneSide {
 public:
  explicit MembraneSide(const Membrane& membrane);

  /// Whether a point between the planes at the ends is beyond the membrane. A line through an edge
  /// of the mesh could count it twice or not at all, so it takes three lines to say so.
  [[nodiscard]] bool is_outside(const Vec3& point) const;

 private:
  /// Along the radius at right angles to it, and along the axis, from the foot.
  struct Place {
    double u;  // [m]
    double v;  // [m]
    double height;
  };
  using Triangle = std::array<std::uint32_t, 3>;
  [[nodiscard]] Place place_of(const Vec3& point) const;
  [[nodiscard]] std::size_t row_of(double height) const;
  [[nodiscard]] double turns_of(const Place& place) const;
  [[nodiscard]] std::size_t column_of(double turns) const;
  void add(const Triangle& triangle);
  [[nodiscard]] bool crosses(const Place& from, const Triangle& triangle) const;
  [[nodiscard]] bool crosses_oddly(const Place& from) const;

  Vec3 foot_;
  Vec3 axis_u_;
  Vec3 axis_v_;
  Vec3 axis_unit_;
  double radius_;
  double low_{0};   // of all nodes, along the axis [m]
  double high_{0};  // [m]
  std::size_t columns_;
  std::size_t rows_;
  std::vector<Place> nodes_;
  std::vector<std::vector<Triangle>> bins_;
};

}  // namespace reckon
