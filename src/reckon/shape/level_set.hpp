// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "reckon/math/vec3.hpp"
#include "reckon/shape/level_set_band.hpp"

namespace reckon {

/// Signed distance to a grain's surface, sampled at the vertices of a regular grid that is fixed
/// to the grain's body frame. Negative inside. x runs fastest, then y, then z.
struct LevelSet {
  std::array<std::int32_t, 3> dims{0, 0, 0};  ///< vertices along x, y, z; at least 2 each
  double spacing{0};                          ///< distance between neighbouring vertices [m]
  Vec3 origin_body;                           ///< where vertex (0, 0, 0) lies in the body frame [m]
  std::vector<float> values;                  ///< signed distances [m]

  [[nodiscard]] std::size_t index(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(dims[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(k));
  }
  [[nodiscard]] Vec3 vertex_body(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return origin_body +
           spacing * Vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
  }
};

/// Trilinear interpolation in one cell, as a polynomial of the place (x, y, z) in [0, 1]^3:
/// c0 + c1 x + c2 y + c3 z + c4 xy + c5 xz + c6 yz + c7 xyz  (paper, Algorithm 1).
struct CellPolynomial {
  std::array<double, 8> c{};

  [[nodiscard]] double value(double x, double y, double z) const {
    return c[0] + c[1] * x + c[2] * y + c[3] * z + c[4] * x * y + c[5] * x * z + c[6] * y * z +
           c[7] * x * y * z;
  }
  /// The exact gradient of value(), per cell length.
  [[nodiscard]] Vec3 gradient(double x, double y, double z) const {
    return {c[1] + c[4] * y + c[5] * z + c[7] * y * z, c[2] + c[4] * x + c[6] * z + c[7] * x * z,
            c[3] + c[5] * x + c[6] * y + c[7] * x * y};
  }
};

/// A level set as the kernels read it: all its values, or a band of them. Does not own.
struct LevelSetView {
  std::array<std::int32_t, 3> dims{0, 0, 0};
  double spacing{0};
  double inverse_spacing{0};
  Vec3 origin_body;
  std::span<const float> values;      ///< empty where there is a band
  const LevelSetBand* band{nullptr};  ///< or null

  LevelSetView() = default;
  LevelSetView(const LevelSet& grid)  // NOLINT(google-explicit-constructor): a view, like span
      : LevelSetView{grid.dims, grid.spacing, grid.origin_body, grid.values} {}
  LevelSetView(const std::array<std::int32_t, 3>& grid_dims, double grid_spacing,
               const Vec3& grid_origin_body, std::span<const float> grid_values)
      : dims{grid_dims},
        spacing{grid_spacing},
        inverse_spacing{1 / grid_spacing},
        origin_body{grid_origin_body},
        values{grid_values} {}

  /// The cell that holds a point, and the point's place in it.
  struct Location {
    std::int32_t i, j, k;  ///< the cell's lowest vertex
    double x, y, z;        ///< place in the cell, each in [0, 1]
    bool inside;           ///< false: the point lies outside the grid, the rest is not set
  };

  [[nodiscard]] Location locate(const Vec3& point_body) const {
    const double gx = (point_body.x - origin_body.x) * inverse_spacing;
    const double gy = (point_body.y - origin_body.y) * inverse_spacing;
    const double gz = (point_body.z - origin_body.z) * inverse_spacing;
    // Written so that a NaN counts as outside.
    if (!(gx >= 0 && gy >= 0 && gz >= 0 && gx <= dims[0] - 1 && gy <= dims[1] - 1 &&
          gz <= dims[2] - 1)) {
      return {0, 0, 0, 0, 0, 0, false};
    }
    const auto cell = [](double g, std::int32_t vertices) {
      const auto floor = static_cast<std::int32_t>(g);
      return floor < vertices - 1 ? floor : vertices - 2;  // the last vertex closes the last cell
    };
    const std::int32_t i = cell(gx, dims[0]);
    const std::int32_t j = cell(gy, dims[1]);
    const std::int32_t k = cell(gz, dims[2]);
    return {i, j, k, gx - i, gy - j, gz - k, true};
  }

  /// phi at the corners of a cell: bit 0 of the place is one step along x, bit 1 y, bit 2 z [m].
  [[nodiscard]] std::array<double, 8> corners(std::int32_t i, std::int32_t j,
                                              std::int32_t k) const {
    if (band != nullptr) {
      const auto [a, b, c, d, e, f, g, h] = band->corners(i, j, k);
      return {a, b, c, d, e, f, g, h};
    }
    const auto nx = static_cast<std::size_t>(dims[0]);
    const auto nxy = nx * static_cast<std::size_t>(dims[1]);
    const std::size_t base = static_cast<std::size_t>(i) + nx * static_cast<std::size_t>(j) +
                             nxy * static_cast<std::size_t>(k);
    const float* const v = &values[base];
    return {v[0], v[1], v[nx], v[nx + 1], v[nxy], v[nxy + 1], v[nxy + nx], v[nxy + nx + 1]};
  }

  [[nodiscard]] CellPolynomial polynomial(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const auto [v000, v100, v010, v110, v001, v101, v011, v111] = corners(i, j, k);
    return {{v000, v100 - v000, v010 - v000, v001 - v000, v110 - v100 - v010 + v000,
             v101 - v100 - v001 + v000, v011 - v010 - v001 + v000,
             v111 - v110 - v101 - v011 + v100 + v010 + v001 - v000}};
  }

  /// Value and gradient at a point of the body frame.
  struct Sample {
    double phi;          ///< signed distance [m]
    Vec3 gradient_body;  ///< of the interpolant, dimensionless, not normalised
    bool inside_grid;    ///< false: the point lies outside the grid, the rest is not set
  };

  [[nodiscard]] Sample sample(const Vec3& point_body) const {
    const Location at = locate(point_body);
    if (!at.inside) return {0, {}, false};
    const CellPolynomial cell = polynomial(at.i, at.j, at.k);
    return {cell.value(at.x, at.y, at.z), inverse_spacing * cell.gradient(at.x, at.y, at.z), true};
  }
};

/// The largest gradient norm that trilinear interpolation of `grid` reaches in any cell that is not
/// wholly inside the grain. A point of the grid with phi = d >= 0 is therefore at least
/// d / lipschitz_constant(grid) away from every point with phi < 0. (In a cell the gradient is
/// linear along each axis, so its norm is largest at a vertex.)
[[nodiscard]] double lipschitz_constant(const LevelSet& grid);

}  // namespace reckon
