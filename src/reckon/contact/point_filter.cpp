// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/point_filter.hpp"

#include <algorithm>
#include <cmath>

namespace reckon {
namespace {

/// Where a coordinate inside the grid lies: its cell, and the place in it.
struct Place {
  std::int32_t cell;
  float part;
};
Place place_in(float g, std::int32_t last_cell) {
  const std::int32_t cell = std::min(static_cast<std::int32_t>(g), last_cell);
  return {cell, g - static_cast<float>(cell)};
}

float between(float low, float high, float part) { return low + part * (high - low); }

std::array<float, 8> corners(const FilterTarget& t, std::int32_t i, std::int32_t j,
                             std::int32_t k) {
  if (t.band != nullptr) return t.band->corners(i, j, k);
  const float* const v = t.values + (i + j * t.row + k * t.layer);
  const float* const w = v + t.layer;
  return {v[0], v[1], v[t.row], v[t.row + 1], w[0], w[1], w[t.row], w[t.row + 1]};
}

/// One point; the vector variants do just this. `r` is the radius around it.
float clearance_of(const FilterTarget& t, float x, float y, float z, float r) {
  std::array<float, 3> g{};
  for (std::size_t i = 0; i < 3; ++i) {
    g[i] = ((t.turn[3 * i] * x + t.turn[3 * i + 1] * y) + t.turn[3 * i + 2] * z) + t.shift[i];
  }
  const float cx = g[0] - t.center[0];
  const float cy = g[1] - t.center[1];
  const float cz = g[2] - t.center[2];
  const float from_sphere = (std::sqrt((cx * cx + cy * cy) + cz * cz) - t.radius) - r;
  if (!(from_sphere <= t.skin)) return from_sphere;

  std::array<float, 3> inside{};
  for (std::size_t i = 0; i < 3; ++i) inside[i] = std::min(std::max(g[i], 0.0F), t.high[i]);
  const float ox = g[0] - inside[0];
  const float oy = g[1] - inside[1];
  const float oz = g[2] - inside[2];
  const float outside = (ox * ox + oy * oy) + oz * oz;
  const Place px = place_in(inside[0], t.last_cell[0]);
  const Place py = place_in(inside[1], t.last_cell[1]);
  const Place pz = place_in(inside[2], t.last_cell[2]);
  const std::array<float, 8> v = corners(t, px.cell, py.cell, pz.cell);
  const float v00 = between(v[0], v[1], px.part);
  const float v10 = between(v[2], v[3], px.part);
  const float v01 = between(v[4], v[5], px.part);
  const float v11 = between(v[6], v[7], px.part);
  const float phi = between(between(v00, v10, py.part), between(v01, v11, py.part), pz.part);
  const float from_phi = phi * t.phi_to_clearance;
  const float positive = std::max(from_phi, 0.0F);
  const float from_grid = outside > 0 ? std::sqrt(outside + positive * positive) : from_phi;
  return std::max(from_sphere, from_grid - r);
}

void scalar_filter(const FilterTarget& target, const FilterPoints& points, float* clearance) {
  for (std::size_t n = 0; n < points.count; ++n) {
    const float radius = points.radius == nullptr ? 0.0F : points.radius[n];
    clearance[n] = clearance_of(target, points.x[n], points.y[n], points.z[n], radius);
  }
}

}  // namespace

FilterTarget::FilterTarget(const ShapeView& grain, const RelativePose& at, double master_radius,
                           double skin_metres)
    : values{grain.level_set.values.data()},
      band{grain.level_set.band},
      spacing{grain.level_set.spacing} {
  const LevelSetView& grid = grain.level_set;
  inverse_spacing = 1 / spacing;
  const auto in_cells = [this](double length) {
    return static_cast<float>(length * inverse_spacing);
  };
  double widest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    const Vec3& turn_row = i == 0 ? at.turn.row_x : i == 1 ? at.turn.row_y : at.turn.row_z;
    for (int j = 0; j < 3; ++j) turn[3 * i + static_cast<std::size_t>(j)] = in_cells(turn_row[j]);
    shift[i] = in_cells(at.shift[axis] - grid.origin_body[axis]);
    center[i] = in_cells(-grid.origin_body[axis]);
    high[i] = static_cast<float>(grid.dims[i] - 1);
    last_cell[i] = grid.dims[i] - 2;
    widest = std::max(widest, std::abs(grid.origin_body[axis]) * inverse_spacing + grid.dims[i]);
  }
  radius = in_cells(grain.bounding_radius);
  row = grid.dims[0];
  layer = grid.dims[0] * grid.dims[1];
  phi_to_clearance = grain.lipschitz > 0 ? in_cells(1 / grain.lipschitz) : 0.0F;
  // A point is off by about 50 units in the last place of the largest length that meets it here.
  margin = 1e-5 * ((master_radius + grain.bounding_radius) * inverse_spacing + widest);
  skin = static_cast<float>(skin_metres * inverse_spacing + margin);
}

PointFilter point_filter(SimdLevel level) {
  const SimdLevel resolved = resolve(level);
  return resolved == SimdLevel::scalar ? scalar_filter : vector_point_filter(resolved);
}

}  // namespace reckon
