// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "reckon/shape/shape.hpp"

namespace reckon {

/// How far a point may move, in any direction, before it can lie inside a grain: lower bounds of
/// the distance to the set of points that a finder accepts, which has phi < 0, lies in the grid
/// and in the bounding sphere. May be negative. Points are in the grain's body frame.
///
///                    ______________
///        p o--------|p'   grid     |     |p - q|^2 >= |p - p'|^2 + |p' - q|^2  (a box is convex)
///                   | `-.   ____   |     |p' - q|  >= phi(p') / L              (Lipschitz)
///                   |    `q/    \  |
///                   |      \____/  |
///                   |______________|
class Clearance {
 public:
  explicit Clearance(const ShapeView& grain)
      : grid_{grain.level_set},
        radius_{grain.bounding_radius},
        slope_{grain.lipschitz > 0 ? 1 / grain.lipschitz : 0},
        high_{grid_.origin_body + grid_.spacing * Vec3{static_cast<double>(grid_.dims[0] - 1),
                                                       static_cast<double>(grid_.dims[1] - 1),
                                                       static_cast<double>(grid_.dims[2] - 1)}} {}

  /// From the bounding sphere alone [m].
  [[nodiscard]] double of_sphere(const Vec3& point) const { return norm(point) - radius_; }

  /// From an interpolated distance [m].
  [[nodiscard]] double of_phi(double phi) const { return phi * slope_; }

  /// From the grid [m].
  [[nodiscard]] double of_grid(const Vec3& point) const {
    const Vec3& low = grid_.origin_body;
    const Vec3 inside{std::clamp(point.x, low.x, high_.x), std::clamp(point.y, low.y, high_.y),
                      std::clamp(point.z, low.z, high_.z)};
    const double outside_squared = squared_norm(point - inside);
    const double from_phi = of_phi(phi_near(inside));
    if (outside_squared == 0) return from_phi;
    if (from_phi <= 0) return std::sqrt(outside_squared);
    return std::sqrt(outside_squared + from_phi * from_phi);
  }

 private:
  /// phi at a point that lies in the grid but for rounding.
  [[nodiscard]] double phi_near(const Vec3& point) const {
    const auto place = [this](double p, double low, std::int32_t vertices) {
      const double g = (p - low) * grid_.inverse_spacing;
      const std::int32_t cell =
          std::clamp(static_cast<std::int32_t>(g), std::int32_t{0}, vertices - 2);
      return std::pair{cell, std::clamp(g - cell, 0.0, 1.0)};
    };
    const auto [i, x] = place(point.x, grid_.origin_body.x, grid_.dims[0]);
    const auto [j, y] = place(point.y, grid_.origin_body.y, grid_.dims[1]);
    const auto [k, z] = place(point.z, grid_.origin_body.z, grid_.dims[2]);
    return grid_.polynomial(i, j, k).value(x, y, z);
  }

  const LevelSetView& grid_;
  double radius_;
  double slope_;
  Vec3 high_;
};

}  // namespace reckon
