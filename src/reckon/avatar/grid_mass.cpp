// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/grid_mass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reckon {
namespace {

using std::numbers::pi;

double cosine_step(double s) {
  const double u = std::clamp(s, -1.0, 1.0);
  return 0.5 * (1 + u + std::sin(pi * u) / pi);
}
double cosine_delta(double s) { return std::abs(s) < 1 ? 0.5 * (1 + std::cos(pi * s)) : 0.0; }

/// Of the depth below the surface, in spacings.
double smoothed_step(double depth) { return (4 * cosine_step(depth) - cosine_step(depth / 2)) / 3; }
double smoothed_delta(double depth) {
  return (4 * cosine_delta(depth) - cosine_delta(depth / 2) / 2) / 3;
}

}  // namespace

SolidProperties grid_properties(const LevelSetView& grid) {
  // Places are in spacings from vertex (0, 0, 0), sums row by row: rounding grows with the number
  // of rows, not of vertices.
  double volume = 0;
  double area = 0;
  Vec3 first;
  Vec3 second;        // xx, yy, zz
  Vec3 second_mixed;  // yz, xz, xy
  std::size_t v = 0;
  for (std::int32_t k = 0; k < grid.dims[2]; ++k) {
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      double row = 0;
      double row_x = 0;
      double row_xx = 0;
      double row_area = 0;
      for (std::int32_t i = 0; i < grid.dims[0]; ++i, ++v) {
        const double depth = -double{grid.values[v]} / grid.spacing;
        if (depth <= -2) continue;  // of no weight
        const double weight = depth >= 2 ? 1 : smoothed_step(depth);
        row += weight;
        row_x += weight * i;
        row_xx += weight * i * i;
        if (depth < 2) row_area += smoothed_delta(depth);
      }
      const double y = j;
      const double z = k;
      volume += row;
      area += row_area;
      first += Vec3{row_x, y * row, z * row};
      second += Vec3{row_xx, y * y * row, z * z * row};
      second_mixed += Vec3{y * z * row, z * row_x, y * row_x};
    }
  }
  const Vec3 center = first / volume;
  second -= hadamard(center, first);
  second_mixed -= Vec3{center.y * first.z, center.x * first.z, center.x * first.y};
  const double h = grid.spacing;
  const double h5 = h * h * h * h * h;
  SolidProperties properties;
  properties.volume = volume * h * h * h;
  properties.surface_area = area * h * h;
  properties.centroid = grid.origin_body + h * center;
  const double trace = second.x + second.y + second.z;
  properties.inertia = {h5 * Vec3{trace - second.x, -second_mixed.z, -second_mixed.y},
                        h5 * Vec3{-second_mixed.z, trace - second.y, -second_mixed.x},
                        h5 * Vec3{-second_mixed.y, -second_mixed.x, trace - second.z}};
  return properties;
}

double plain_grid_volume(const LevelSetView& grid) {
  double count = 0;
  for (const float phi : grid.values) count += phi < 0 ? 1.0 : phi > 0 ? 0.0 : 0.5;
  return count * grid.spacing * grid.spacing * grid.spacing;
}

}  // namespace reckon
