// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/inside_radius.hpp"

#include <algorithm>
#include <cmath>

namespace reckon {
namespace {

// Boxes are halved down to 2^-6 of a cell; their diagonals are then below 3 % of a spacing.
constexpr int deepest_level = 6;
constexpr double rounding = 1e-12;

class RadiusSearch {
 public:
  RadiusSearch(const LevelSetView& grid, double at_least) : grid_{grid}, radius_{at_least} {}

  double run() {
    // Vertices first: the better the radius to begin with, the fewer cells are opened.
    visit_vertices();
    for (std::int32_t k = 0; k + 1 < grid_.dims[2]; ++k) {
      for (std::int32_t j = 0; j + 1 < grid_.dims[1]; ++j) {
        for (std::int32_t i = 0; i + 1 < grid_.dims[0]; ++i) {
          cell_corner_ = grid_.origin_body + grid_.spacing * Vec3{static_cast<double>(i),
                                                                  static_cast<double>(j),
                                                                  static_cast<double>(k)};
          if (farthest({0, 0, 0}, 1) <= radius_) continue;
          cell_ = grid_.polynomial(i, j, k);
          double largest = 0;
          for (const double c : cell_.c) largest = std::max(largest, std::abs(c));
          tolerance_ = rounding * largest;
          search({0, 0, 0}, 1, 0);
        }
      }
    }
    return radius_ * (1 + rounding);
  }

 private:
  void visit_vertices() {
    std::size_t v = 0;
    for (std::int32_t k = 0; k < grid_.dims[2]; ++k) {
      for (std::int32_t j = 0; j < grid_.dims[1]; ++j) {
        for (std::int32_t i = 0; i < grid_.dims[0]; ++i, ++v) {
          if (grid_.values[v] >= 0) continue;
          const Vec3 place{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
          radius_ = std::max(radius_, norm(grid_.origin_body + grid_.spacing * place));
        }
      }
    }
  }

  /// Distance of the farthest corner of a box of the current cell from the body origin. `low` and
  /// `size` are in cell lengths.
  [[nodiscard]] double farthest(const Vec3& low, double size) const {
    const Vec3 a = cell_corner_ + grid_.spacing * low;
    const Vec3 b = a + grid_.spacing * Vec3{size, size, size};
    const auto larger = [](double p, double q) { return std::max(std::abs(p), std::abs(q)); };
    return norm(Vec3{larger(a.x, b.x), larger(a.y, b.y), larger(a.z, b.z)});
  }

  [[nodiscard]] bool may_hold_inside(const Vec3& low, double size) const {
    for (unsigned corner = 0; corner < 8; ++corner) {
      const double x = low.x + ((corner & 1U) != 0 ? size : 0);
      const double y = low.y + ((corner & 2U) != 0 ? size : 0);
      const double z = low.z + ((corner & 4U) != 0 ? size : 0);
      if (cell_.value(x, y, z) < tolerance_) return true;
    }
    return false;
  }

  void search(const Vec3& low, double size, int level) {
    const double reach = farthest(low, size);
    if (reach <= radius_ || !may_hold_inside(low, size)) return;
    if (level == deepest_level) {
      radius_ = reach;
      return;
    }
    const double half = size / 2;
    // The far octant first: its result may decide the others.
    const unsigned away = (cell_corner_.x > 0 ? 1U : 0U) | (cell_corner_.y > 0 ? 2U : 0U) |
                          (cell_corner_.z > 0 ? 4U : 0U);
    for (unsigned o = 0; o < 8; ++o) {
      const unsigned octant = (7U - o) ^ (7U ^ away);
      search(low + half * Vec3{(octant & 1U) != 0 ? 1.0 : 0.0, (octant & 2U) != 0 ? 1.0 : 0.0,
                               (octant & 4U) != 0 ? 1.0 : 0.0},
             half, level + 1);
    }
  }

  LevelSetView grid_;
  double radius_;
  Vec3 cell_corner_;
  CellPolynomial cell_;
  double tolerance_{0};
};

}  // namespace

double inside_radius(const LevelSetView& grid, double at_least) {
  return RadiusSearch{grid, at_least}.run();
}

}  // namespace reckon
