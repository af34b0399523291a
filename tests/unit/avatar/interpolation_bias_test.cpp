// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/interpolation_bias.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/shape_builder.hpp"
#include "reckon/core/random.hpp"

namespace reckon {
namespace {

using std::numbers::pi;

Shape sphere(double voxels) {
  return build_shape(sphere_mesh(1, 1 / voxels),
                     {.voxels_per_diameter = voxels, .node_count = 3200}, "sphere",
                     SurfaceKind::solid);
}

Vec3 direction(int n) {
  RandomStream random{3, RandomPurpose::other, static_cast<std::uint64_t>(n)};
  Vec3 ray;
  do {
    for (int axis = 0; axis < 3; ++axis) ray[axis] = random.uniform(-1, 1);
  } while (norm(ray) > 1);
  return normalized(ray);
}

/// Where the interpolant is zero along a ray from the centre.
double zero_along(const LevelSetView& grid, const Vec3& ray) {
  double inside = 0.8;
  double outside = 1.1;
  for (int round = 0; round < 50; ++round) {
    const double middle = 0.5 * (inside + outside);
    (grid.sample(middle * ray).phi < 0 ? inside : outside) = middle;
  }
  return inside;
}

TEST(InterpolationBias, ZeroOfASphereLiesOnTheSphere) {
  for (const double voxels : {12.0, 20.0, 30.0, 50.0}) {
    const Shape shape = sphere(voxels);
    const double h = shape.level_set.spacing;
    double mean = 0;
    double squares = 0;
    constexpr int rays = 4000;
    for (int n = 0; n < rays; ++n) {
      const double miss = zero_along(shape.level_set, direction(n)) - 1;
      mean += miss / rays;
      squares += miss * miss / rays;
    }
    // Without correction it lies h^2 / 6 inside.
    EXPECT_LT(std::abs(mean), 0.06 * h * h / 6) << voxels;
    EXPECT_LT(std::sqrt(squares), 0.5 * h * h / 6) << voxels;
  }
}

/// Mean of the normal force between a sphere and a plate over orientations, divided by the closed
/// form of law `area`: pi R k d^2 by the sphere's nodes in the plate, and pi (R - d) k d^2 by those
/// of a fine plate in the sphere's grid, whose disc is smaller than the cap.
struct Forces {
  double by_nodes;
  double by_grid;
};
Forces forces(double voxels, double overlap) {
  const Shape shape = sphere(voxels);
  const LevelSetView grid{shape.level_set};
  const double right = pi * overlap * overlap;
  const double right_on_disc = (1 - overlap) * right;
  Forces sum{0, 0};
  constexpr int orientations = 100;
  constexpr int points = 60;  // along half of the plate
  const double reach = 1.2 * std::sqrt(2 * overlap);
  for (int n = 0; n < orientations; ++n) {
    const Vec3 up = direction(n);
    for (std::size_t node = 0; node < shape.nodes.size(); ++node) {
      const double depth = dot(shape.nodes.position(node), up) - (1 - overlap);
      if (depth > 0) sum.by_nodes += shape.nodes.area[node] * depth / right / orientations;
    }
    const Vec3 u = normalized(cross(up, std::abs(up.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
    const Vec3 v = cross(up, u);
    for (int a = -points; a <= points; ++a) {
      for (int b = -points; b <= points; ++b) {
        const Vec3 at = (1 - overlap) * up + (reach * a / points) * u + (reach * b / points) * v;
        const auto sample = grid.sample(at);
        if (sample.phi >= 0) continue;
        const double area = (reach / points) * (reach / points);
        sum.by_grid -=
            area * sample.phi * dot(sample.gradient_body, up) / right_on_disc / orientations;
      }
    }
  }
  return sum;
}

TEST(InterpolationBias, SphereOnAPlatePushesAsTheClosedFormSays) {
  const Forces coarse = forces(20, 0.04);
  EXPECT_NEAR(coarse.by_nodes, 1, 0.01);
  EXPECT_NEAR(coarse.by_grid, 1, 0.01);
  const Forces fine = forces(30, 0.04);
  EXPECT_NEAR(fine.by_nodes, 1, 0.005);
  EXPECT_NEAR(fine.by_grid, 1, 0.005);
  RecordProperty("by_nodes_20", std::to_string(coarse.by_nodes));
  RecordProperty("by_grid_20", std::to_string(coarse.by_grid));
  RecordProperty("by_nodes_30", std::to_string(fine.by_nodes));
  RecordProperty("by_grid_30", std::to_string(fine.by_grid));
}

TEST(InterpolationBias, FlatFacesOfABoxStayExactUpToTheirEdges) {
  const Vec3 half{1, 0.7, 0.5};
  const Shape shape = build_shape(box_mesh(half, 0.1), {}, "box", SurfaceKind::solid);
  const LevelSet& grid = shape.level_set;
  const BoxDistance distance{{half.x, half.y, half.z}};
  int near = 0;
  for (std::int32_t k = 0; k < grid.dims[2]; ++k) {
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      for (std::int32_t i = 0; i < grid.dims[0]; ++i) {
        const double expected = distance(grid.vertex_body(i, j, k));
        if (std::abs(expected) > 1.7 * grid.spacing) continue;
        ASSERT_NEAR(grid.values[grid.index(i, j, k)], expected, 1e-6 * grid.spacing);
        ++near;
      }
    }
  }
  EXPECT_GT(near, 1000);
}

TEST(InterpolationBias, SideOfACylinderIsCorrectedAndItsCapsAreNot) {
  const Shape shape = build_shape(cylinder_mesh(1, 1, 0.04), {}, "cylinder", SurfaceKind::solid);
  const LevelSetView grid{shape.level_set};
  const double h = grid.spacing;
  // The body's axes go by its moments: all three are principal, and z stays the odd one.
  double mean = 0;
  constexpr int rays = 2000;
  const bool is_slender = shape.mass.inertia.x < 0.99 * shape.mass.inertia.y;
  const int axis = is_slender ? 0 : 2;
  for (int n = 0; n < rays; ++n) {
    const double turn = 2 * pi * n / rays;
    Vec3 ray;
    ray[(axis + 1) % 3] = std::cos(turn);
    ray[(axis + 2) % 3] = std::sin(turn);
    Vec3 lift;
    lift[axis] = 0.6 * std::sin(7.0 * n);
    double inside = 0.8;
    double outside = 1.2;
    for (int round = 0; round < 50; ++round) {
      const double middle = 0.5 * (inside + outside);
      (grid.sample(middle * ray + lift).phi < 0 ? inside : outside) = middle;
    }
    mean += (inside - 1) / rays;
    Vec3 on_cap;
    on_cap[axis] = 1;
    on_cap[(axis + 1) % 3] = 0.7 * std::cos(turn);
    on_cap[(axis + 2) % 3] = 0.7 * std::sin(turn);
    EXPECT_NEAR(grid.sample(on_cap).phi, 0, 1e-6 * h);
  }
  EXPECT_LT(std::abs(mean), 0.1 * h * h / 12);  // without correction h^2 / 12 inside
}

}  // namespace
}  // namespace reckon
