// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include "reckon/shape/shape.hpp"

namespace reckon::testing {

/// Samples `distance` on a grid of half-width `half` in each axis, padded by three spacings.
inline LevelSet sample_distance(const std::function<double(const Vec3&)>& distance,
                                const Vec3& half, double spacing) {
  LevelSet grid;
  grid.spacing = spacing;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cells = static_cast<std::int32_t>(std::ceil(half[axis] / spacing)) + 3;
    grid.dims[static_cast<std::size_t>(axis)] = 2 * cells + 1;
    grid.origin_body[axis] = -cells * spacing;
  }
  for (std::int32_t k = 0; k < grid.dims[2]; ++k) {
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      for (std::int32_t i = 0; i < grid.dims[0]; ++i) {
        grid.values.push_back(static_cast<float>(distance(grid.vertex_body(i, j, k))));
      }
    }
  }
  return grid;
}

/// A sphere with exact mass properties and `node_count` nodes on a Fibonacci spiral of equal areas.
inline Shape sphere(double radius, int node_count, double voxels_per_diameter = 40) {
  Shape shape;
  shape.name = "sphere";
  shape.level_set = sample_distance([radius](const Vec3& p) { return norm(p) - radius; },
                                    {radius, radius, radius}, 2 * radius / voxels_per_diameter);
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int n = 0; n < node_count; ++n) {
    const double z = 1 - (2 * n + 1.0) / node_count;
    const double around = std::sqrt(1 - z * z);
    shape.nodes.x.push_back(radius * around * std::cos(golden * n));
    shape.nodes.y.push_back(radius * around * std::sin(golden * n));
    shape.nodes.z.push_back(radius * z);
    shape.nodes.area.push_back(4 * std::numbers::pi * radius * radius / node_count);
  }
  const double volume = 4 * std::numbers::pi / 3 * radius * radius * radius;
  const double moment = 0.4 * volume * radius * radius;
  shape.mass = {volume, {moment, moment, moment}};
  shape.bounding_radius = radius * (1 + 1e-6);
  shape.lipschitz = lipschitz_constant(shape.level_set);
  shape.clusters = make_clusters(shape.nodes);
  return shape;
}

/// A box with half-widths `half`, nodes on a regular pattern of its faces (`per_edge` squared per
/// face, at the centres of equal rectangles).
inline Shape box(const Vec3& half, int per_edge, double spacing) {
  Shape shape;
  shape.name = "box";
  const auto distance = [half](const Vec3& p) {
    const Vec3 q{std::abs(p.x) - half.x, std::abs(p.y) - half.y, std::abs(p.z) - half.z};
    const Vec3 out{std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0)};
    return norm(out) + std::min(std::max(q.x, std::max(q.y, q.z)), 0.0);
  };
  shape.level_set = sample_distance(distance, half, spacing);
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0}) {
      for (int a = 0; a < per_edge; ++a) {
        for (int b = 0; b < per_edge; ++b) {
          Vec3 p;
          p[axis] = side * half[axis];
          p[u] = half[u] * ((2 * a + 1.0) / per_edge - 1);
          p[v] = half[v] * ((2 * b + 1.0) / per_edge - 1);
          shape.nodes.x.push_back(p.x);
          shape.nodes.y.push_back(p.y);
          shape.nodes.z.push_back(p.z);
          shape.nodes.area.push_back(4 * half[u] * half[v] / (per_edge * per_edge));
        }
      }
    }
  }
  const double volume = 8 * half.x * half.y * half.z;
  shape.mass = {volume,
                volume / 3 *
                    Vec3{half.y * half.y + half.z * half.z, half.z * half.z + half.x * half.x,
                         half.x * half.x + half.y * half.y}};
  shape.bounding_radius = norm(half) * (1 + 1e-6);
  shape.lipschitz = lipschitz_constant(shape.level_set);
  shape.clusters = make_clusters(shape.nodes);
  return shape;
}

/// A bumpy ellipsoid-like grain without symmetry: phi is a smooth implicit function made a distance
/// to first order, nodes are projected onto its interpolated zero.
inline Shape bumpy_grain(double radius, int node_count, double voxels_per_diameter = 20) {
  Shape shape = sphere(radius, node_count, voxels_per_diameter);
  shape.name = "bumpy";
  const auto surface = [radius](const Vec3& p) {
    const double r = norm(p);
    if (r == 0) return -0.7 * radius;
    const Vec3 u = p / r;
    const double bump = 0.12 * std::sin(3 * u.x + 1) * std::cos(4 * u.y) + 0.1 * u.z * u.x +
                        0.08 * (u.y * u.y - u.z * u.z);
    return 0.9 * (r - radius * (0.85 + bump));
  };
  shape.level_set =
      sample_distance(surface, {radius, radius, radius}, 2 * radius / voxels_per_diameter);
  const LevelSetView view{shape.level_set};
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    Vec3 p = shape.nodes.position(n);
    for (int round = 0; round < 30; ++round) {
      const auto at = view.sample(p);
      p -= (at.phi / squared_norm(at.gradient_body)) * at.gradient_body;
    }
    shape.nodes.x[n] = p.x;
    shape.nodes.y[n] = p.y;
    shape.nodes.z[n] = p.z;
  }
  shape.mass.inertia = hadamard(shape.mass.inertia, {0.7, 0.9, 1.1});
  shape.bounding_radius = 1.1 * radius;
  shape.lipschitz = lipschitz_constant(shape.level_set);
  shape.clusters = make_clusters(shape.nodes);
  return shape;
}

inline std::vector<ShapeView> views_of(const ShapeLibrary& shapes) {
  return {shapes.begin(), shapes.end()};
}

inline std::shared_ptr<const ShapeLibrary> library_of(std::vector<Shape> shapes) {
  return std::make_shared<const ShapeLibrary>(std::move(shapes));
}

}  // namespace reckon::testing
