// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/interpolation_bias.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "reckon/avatar/distance_transform.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

// The six neighbours of such vertices lie within exact_band, where distances are exact.
constexpr double core = 0.75;  // [spacings]
// Second differences along an axis up to the first are curvature, beyond the second an edge.
constexpr double smooth_bend = 0.5;  // [spacings]
constexpr double sharp_bend = 0.8;   // [spacings]
static_assert(core + 1 <= exact_band);

enum class Vertex : std::uint8_t { plain, shifted, at_crease };

class Bias {
 public:
  explicit Bias(const LevelSet& grid)
      : grid_{grid}, kind_(grid.values.size(), Vertex::plain), shift_(grid.values.size(), 0.0F) {}

  /// Marks the vertices within two cells of a sharp edge. One that is shorter than two spacings is
  /// roughness that the grid does not resolve.
  void keep_around(const TriangleMesh& mesh, const std::vector<Crease>& creases) {
    for (const Crease& crease : creases) {
      const std::vector<Vec3> line = line_along(mesh, crease);
      double length = 0;
      for (std::size_t v = 1; v < line.size(); ++v) length += norm(line[v] - line[v - 1]);
      if (length < 2 * grid_.spacing) continue;
      for (std::size_t v = 1; v < line.size(); ++v) keep_along(line[v - 1], line[v]);
    }
  }

  void measure() {
    for_each_inner_vertex([&](std::int32_t i, std::int32_t j, std::int32_t k, std::size_t v) {
      if (kind_[v] != Vertex::plain || !(std::abs(grid_.values[v]) <= core * grid_.spacing)) return;
      const double here = 2 * double{grid_.values[v]};
      const auto at = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        return double{grid_.values[grid_.index(x, y, z)]};
      };
      const double along_x = at(i - 1, j, k) + at(i + 1, j, k) - here;
      const double along_y = at(i, j - 1, k) + at(i, j + 1, k) - here;
      const double along_z = at(i, j, k - 1) + at(i, j, k + 1) - here;
      const double bend = std::max({std::abs(along_x), std::abs(along_y), std::abs(along_z)});
      const double share =
          std::clamp((sharp_bend - bend / grid_.spacing) / (sharp_bend - smooth_bend), 0.0, 1.0);
      shift_[v] = static_cast<float>(share * (along_x + along_y + along_z) / 12);
      kind_[v] = Vertex::shifted;
    });
  }

  /// Gives vertices around the shifted ones the mean of their shifts: cells that the surface cuts
  /// have corners farther away than the core.
  void extend() {
    const std::vector<Vertex> before = kind_;
    for_each_inner_vertex([&](std::int32_t i, std::int32_t j, std::int32_t k, std::size_t v) {
      const bool is_near = std::abs(grid_.values[v]) <= exact_band * grid_.spacing;
      if (before[v] != Vertex::plain || !is_near) return;
      double sum = 0;
      int count = 0;
      for (std::int32_t z = k - 1; z <= k + 1; ++z) {
        for (std::int32_t y = j - 1; y <= j + 1; ++y) {
          for (std::int32_t x = i - 1; x <= i + 1; ++x) {
            const std::size_t neighbour = grid_.index(x, y, z);
            if (before[neighbour] != Vertex::shifted) continue;
            sum += shift_[neighbour];
            ++count;
          }
        }
      }
      if (count == 0) return;
      shift_[v] = static_cast<float>(sum / count);
      kind_[v] = Vertex::shifted;
    });
  }

  [[nodiscard]] const std::vector<float>& shift() const { return shift_; }

 private:
  void keep_along(const Vec3& from, const Vec3& to) {
    const double length = norm(to - from);
    const int steps = static_cast<int>(std::ceil(2 * length / grid_.spacing));
    for (int step = 0; step <= steps; ++step) {
      const double share = steps == 0 ? 0 : static_cast<double>(step) / steps;
      const Vec3 place = (from + share * (to - from) - grid_.origin_body) / grid_.spacing;
      const auto low = [&](int axis) {
        return std::max(static_cast<std::int32_t>(std::floor(place[axis])) - 1, 0);
      };
      const auto high = [&](int axis) {
        return std::min(static_cast<std::int32_t>(std::floor(place[axis])) + 2,
                        grid_.dims[static_cast<std::size_t>(axis)] - 1);
      };
      for (std::int32_t k = low(2); k <= high(2); ++k) {
        for (std::int32_t j = low(1); j <= high(1); ++j) {
          for (std::int32_t i = low(0); i <= high(0); ++i) {
            kind_[grid_.index(i, j, k)] = Vertex::at_crease;
          }
        }
      }
    }
  }

  template <class Visit>
  void for_each_inner_vertex(Visit&& visit) const {
    for (std::int32_t k = 1; k + 1 < grid_.dims[2]; ++k) {
      for (std::int32_t j = 1; j + 1 < grid_.dims[1]; ++j) {
        for (std::int32_t i = 1; i + 1 < grid_.dims[0]; ++i) visit(i, j, k, grid_.index(i, j, k));
      }
    }
  }

  const LevelSet& grid_;
  std::vector<Vertex> kind_;
  std::vector<float> shift_;  // [m]
};

}  // namespace

void measure_to_curved_surface(LevelSet& grid, const TriangleBvh& bvh,
                               const CurvedSurface& surface) {
  parallel_for(static_cast<std::size_t>(grid.dims[2]), 1, [&](std::size_t layer) {
    const auto k = static_cast<std::int32_t>(layer);
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      for (std::int32_t i = 0; i < grid.dims[0]; ++i) {
        float& phi = grid.values[grid.index(i, j, k)];
        const double distance = std::abs(double{phi});
        if (!(distance <= exact_band * grid.spacing)) continue;
        const auto closest = bvh.closest_point_within(grid.vertex_body(i, j, k),
                                                      distance * (1 + 1e-6) + 1e-6 * grid.spacing);
        if (!closest) continue;
        const Vec3 lift = surface.point(*closest) - closest->point;
        phi -= static_cast<float>(dot(lift, surface.normal(*closest)));
      }
    }
  });
}

void remove_interpolation_bias(LevelSet& grid, const TriangleMesh& mesh,
                               const std::vector<Crease>& creases) {
  Bias bias{grid};
  bias.keep_around(mesh, creases);
  bias.measure();
  bias.extend();
  for (std::size_t v = 0; v < grid.values.size(); ++v) grid.values[v] -= bias.shift()[v];
}

}  // namespace reckon
