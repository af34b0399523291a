// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/shape_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "expect_error.hpp"
#include "grids.hpp"
#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/grid_mass.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/core/random.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

using std::numbers::pi;

TriangleMesh ellipsoid() { return test::stretched(geodesic_sphere(24), {1, 0.7, 0.5}); }

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double v : values) total += v;
  return total;
}

TEST(ShapeBuilder, EllipsoidHasItsMassAndItsFrame) {
  // Turned and moved: the shape must come out the same as from the upright mesh.
  const Mat3 turn = rotation_matrix(normalized(Quaternion{0.8, 0.3, -0.4, 0.2}));
  TriangleMesh mesh = ellipsoid();
  for (Vec3& v : mesh.vertices) v = turn * v + Vec3{5, -3, 7};
  const Shape shape = build_shape(mesh, {}, "ellipsoid");
  const double volume = 4 * pi / 3 * 0.35;
  EXPECT_NEAR(shape.mass.volume / volume, 1, 5e-3);  // the mesh's chords
  // Ascending moments: the longest half axis lies along x.
  EXPECT_NEAR(shape.mass.inertia.x / (volume * (0.49 + 0.25) / 5), 1, 1e-2);
  EXPECT_NEAR(shape.mass.inertia.y / (volume * (1 + 0.25) / 5), 1, 1e-2);
  EXPECT_NEAR(shape.mass.inertia.z / (volume * (1 + 0.49) / 5), 1, 1e-2);
  const TriangleMesh upright = to_principal_frame(mesh);
  const SolidProperties counted =
      grid_properties(sample_signed_distance(TriangleBvh{upright}, shape.level_set.spacing));
  EXPECT_NEAR(counted.volume / shape.mass.volume, 1, 1e-3);
  EXPECT_NEAR(counted.inertia.row_x.x / shape.mass.inertia.x, 1, 2e-3);
  EXPECT_NEAR(norm(counted.centroid), 0, 1e-3 * shape.level_set.spacing);
  EXPECT_NEAR(counted.inertia.row_x.y / shape.mass.inertia.x, 0, 1e-3);
  EXPECT_NEAR(shape.descriptors.length, 2, 0.01);
  EXPECT_NEAR(shape.descriptors.thickness, 1, 0.01);
}

TEST(ShapeBuilder, GridHoldsTheDistanceButForItsCorrectionAndIsPadded) {
  const TriangleMesh mesh = to_principal_frame(ellipsoid());
  const TriangleBvh bvh{mesh};
  const Shape shape = build_shape(mesh, {}, "ellipsoid");
  const LevelSet& grid = shape.level_set;
  // At the tips the radii of curvature are 0.25 and 0.49: h^2 / 12 (1 / 0.25 + 1 / 0.49).
  const double largest_shift = 6.05 / 12 * grid.spacing * grid.spacing;
  for (std::size_t v = 0; v < grid.values.size(); v += 7) {
    const auto nx = static_cast<std::size_t>(grid.dims[0]);
    const auto ny = static_cast<std::size_t>(grid.dims[1]);
    const Vec3 vertex =
        grid.vertex_body(static_cast<std::int32_t>(v % nx), static_cast<std::int32_t>(v / nx % ny),
                         static_cast<std::int32_t>(v / nx / ny));
    const double distance = bvh.signed_distance(vertex);
    const bool near = std::abs(distance) < 1.7 * grid.spacing;
    ASSERT_NEAR(grid.values[v], distance, near ? 1.3 * largest_shift : 0.2 * grid.spacing);
    // The zero moves outwards.
    ASSERT_LT(grid.values[v], distance + (near ? 0.1 * largest_shift : 0.2 * grid.spacing));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto last = grid.dims[static_cast<std::size_t>(axis)] - 1;
    EXPECT_GT(bvh.bounds().low[axis] - grid.origin_body[axis], 2 * grid.spacing);
    EXPECT_GT(grid.origin_body[axis] + last * grid.spacing - bvh.bounds().high[axis],
              2 * grid.spacing);
  }
}

class EveryShape : public ::testing::TestWithParam<int> {
 protected:
  static TriangleMesh mesh() {
    switch (GetParam()) {
      case 0:
        return geodesic_sphere(12);
      case 1:
        return ellipsoid();
      case 2:
        return test::stretched(test::cube(), {1, 0.8, 0.6});
      case 3:
        return test::stretched(test::cube(), {1, 0.9, 0.2});
      default: {
        // A lumpy star: bumps and hollows.
        TriangleMesh star = geodesic_sphere(16);
        for (Vec3& v : star.vertices) {
          v *= 1 + 0.25 * std::sin(4 * v.x + 1) * std::cos(5 * v.y) + 0.1 * std::sin(9 * v.z);
        }
        return star;
      }
    }
  }
};

TEST_P(EveryShape, KeepsItsPromises) {
  const Shape shape = build_shape(mesh(), {}, "shape", SurfaceKind::sampled);
  check_shape(shape, "shape");
  const LevelSetView grid{shape.level_set};
  double farthest = 0;
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    const auto sample = grid.sample(shape.nodes.position(n));
    ASSERT_TRUE(sample.inside_grid);
    EXPECT_LE(std::abs(sample.phi), 1e-9 * grid.spacing);
    farthest = std::max(farthest, norm(shape.nodes.position(n)));
  }
  // Where the mesh is the surface, nodes lie on that.
  const TriangleMesh body = to_principal_frame(mesh());
  const TriangleBvh bvh{body};
  const Shape exact = build_shape(mesh(), {}, "shape");
  for (std::size_t n = 0; n < exact.nodes.size(); ++n) {
    EXPECT_LE(std::abs(bvh.signed_distance(exact.nodes.position(n))), 1e-9 * grid.spacing);
    EXPECT_LE(norm(exact.nodes.position(n)), exact.bounding_radius);
  }
  EXPECT_NEAR(sum(shape.nodes.area) / shape.descriptors.surface_area, 1, 1e-12);
  EXPECT_GT(*std::min_element(shape.nodes.area.begin(), shape.nodes.area.end()), 0);
  EXPECT_GE(shape.bounding_radius, farthest);
  EXPECT_LE(shape.bounding_radius, 1.05 * farthest);
  EXPECT_EQ(shape.lipschitz, lipschitz_constant(shape.level_set));
  EXPECT_GE(shape.lipschitz, 0.99);
  EXPECT_LE(shape.lipschitz, std::sqrt(3) * (1 + 1e-6));
  // No point with phi < 0 beyond the bounding radius.
  RandomStream random{9, RandomPurpose::other, 0};
  for (int n = 0; n < 200000; ++n) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform(-1, 1);
    p = (shape.bounding_radius * random.uniform(1, 1.1)) * normalized(p);
    const auto sample = grid.sample(p);
    ASSERT_TRUE(!sample.inside_grid || sample.phi >= 0);
  }
}

// Areas with the outward normals of the grid close the surface and give its volume (Gauss).
TEST_P(EveryShape, NodeAreasObeyGauss) {
  const Shape shape = build_shape(mesh(), {.voxels_per_diameter = 30, .node_spacing = 0.06}, "s",
                                  SurfaceKind::sampled);
  const LevelSetView grid{shape.level_set};
  Vec3 closure;
  double volume = 0;
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    const Vec3 p = shape.nodes.position(n);
    const Vec3 a = shape.nodes.area[n] * normalized(grid.sample(p).gradient_body);
    closure += a;
    volume += dot(p, a) / 3;
  }
  EXPECT_LT(norm(closure), 0.01 * shape.descriptors.surface_area);
  // At an edge the grid's normal lies between both faces', which counts a little too much.
  EXPECT_NEAR(volume / shape.mass.volume, 1, 0.045);
}

std::string shape_name(const ::testing::TestParamInfo<int>& parameter) {
  constexpr const char* names[] = {"Sphere", "Ellipsoid", "Box", "Plate", "Star"};
  return names[parameter.param];
}
INSTANTIATE_TEST_SUITE_P(Sources, EveryShape, ::testing::Range(0, 5), shape_name);

/// The nodes of a box on one of its faces, edges and corners included, and their areas in all.
struct Face {
  double area{0};
  Vec3 moment;  // of the areas [m^3]
  int nodes{0};
};
Face face_of(const Shape& shape, int axis, double level) {
  Face face;
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    const Vec3 p = shape.nodes.position(n);
    if (std::abs(p[axis] - level) > 1e-9) continue;
    face.area += shape.nodes.area[n];
    face.moment += shape.nodes.area[n] * p;
    ++face.nodes;
  }
  return face;
}

TEST(ShapeBuilder, FacesOfABoxKeepTheirAreaAndReachTheirEdges) {
  const Vec3 half{1, 0.7, 0.5};
  for (const std::uint32_t count : {100U, 300U, 1000U, 5000U}) {
    const Shape shape = build_shape(box_mesh(half, 0.1), {.node_count = count}, "box");
    EXPECT_EQ(shape.nodes.size(), count);
    int corners = 0;
    for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
      corners += norm(shape.nodes.position(n)) > norm(half) * (1 - 1e-9) ? 1 : 0;
    }
    EXPECT_EQ(corners, 8) << count;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const Face face = face_of(shape, axis, side * half[axis]);
        const double area = 4 * half.x * half.y * half.z / half[axis];
        EXPECT_NEAR(face.area / area, 1,
                    count < 200    ? 0.08
                    : count < 1000 ? 0.05
                                   : 0.01)
            << count << ' ' << axis;
        Vec3 off = face.moment / face.area;
        off[axis] = 0;
        EXPECT_LT(norm(off), 0.6 / std::sqrt(count)) << count << ' ' << axis;
      }
    }
  }
}

TEST(ShapeBuilder, NodesOfACurvedSolidLieOnItAndNotOnItsChords) {
  const Shape sphere =
      build_shape(sphere_mesh(1, 0.05), {.node_count = 500}, "s", SurfaceKind::solid);
  for (std::size_t n = 0; n < sphere.nodes.size(); ++n) {
    EXPECT_NEAR(norm(sphere.nodes.position(n)), 1, 1e-5);  // chords: 2e-4
  }
  const Shape drum =
      build_shape(cylinder_mesh(1, 0.3, 0.02), {.node_count = 800}, "drum", SurfaceKind::solid);
  // The shortest axis has the largest moment, so it is z.
  int rims = 0;
  for (std::size_t n = 0; n < drum.nodes.size(); ++n) {
    const Vec3 p = drum.nodes.position(n);
    const double around = std::hypot(p.x, p.y);
    const bool on_side = std::abs(around - 1) < 1e-4;
    const bool on_cap = std::abs(std::abs(p.z) - 0.3) < 1e-9;
    EXPECT_TRUE(on_side || on_cap) << n;
    rims += on_side && on_cap ? 1 : 0;
  }
  EXPECT_GT(rims, 80);
}

TEST(ShapeBuilder, ResolutionMeansWhatItSays) {
  const TriangleMesh mesh = ellipsoid();
  const Shape coarse = build_shape(mesh, {.voxels_per_diameter = 12}, "e");
  EXPECT_NEAR(coarse.descriptors.equivalent_diameter / coarse.level_set.spacing, 12, 1e-9);
  const Shape exact = build_shape(mesh, {.voxel_size = 0.05, .node_count = 123}, "e");
  EXPECT_EQ(exact.level_set.spacing, 0.05);
  EXPECT_EQ(exact.nodes.size(), 123U);
  const Shape spaced = build_shape(mesh, {.node_spacing = 0.2}, "e");
  const double mean_area =
      spaced.descriptors.surface_area / static_cast<double>(spaced.nodes.size());
  EXPECT_NEAR(std::sqrt(mean_area) / spaced.descriptors.equivalent_diameter, 0.2, 0.005);
}

TEST(ShapeBuilder, RefusesWhatItCannotDoWell) {
  const TriangleMesh good = ellipsoid();
  TriangleMesh inward = good;
  for (auto& t : inward.triangles) std::swap(t[0], t[1]);
  test::expect_error([&] { (void)build_shape(inward, {}, "inside-out"); },
                     {"inside-out", "encloses no volume"});
  test::expect_error([&] { (void)build_shape(good, {.voxels_per_diameter = 5}, "e"); },
                     {"too coarse", "5 voxels"});
  test::expect_error([&] { (void)build_shape(good, {.voxel_size = -1}, "e"); }, {"too coarse"});
  test::expect_error([&] { (void)build_shape(good, {.voxel_size = 1e-6}, "e"); }, {"too large"});
  test::expect_error([&] { (void)build_shape(good, {.node_spacing = 0}, "e"); }, {"node"});
  test::expect_error([&] { (void)build_shape(good, {.node_count = 2}, "e"); }, {"node"});
  // A sheet far thinner than a voxel.
  test::expect_error(
      [&] {
        (void)build_shape(test::stretched(test::cube(), {1, 1, 0.002}), {}, "sheet");
      },
      {"sheet", "too coarse"});
}

TEST(ProjectToSurface, FindsTheSurfaceAlsoWhereNewtonCircles) {
  // A tent: the gradient jumps at x = 0, where the top lies.
  const LevelSet tent = test::cube_grid(
      1, 20, {0.013, 0, 0}, [](const Vec3& p) { return p.z + 3 * std::abs(p.x) - 0.2; });
  const LevelSetView grid{tent};
  for (double x = -0.05; x < 0.05; x += 0.003) {
    const auto point = project_to_surface(grid, {x, 0.1, 0.2}, {0, 0, 1});
    ASSERT_TRUE(point.has_value());
    EXPECT_LE(std::abs(grid.sample(*point).phi), 1e-9 * grid.spacing);
  }
  EXPECT_FALSE(project_to_surface(grid, {0, 0, 0.9}, {0, 0, 1}).has_value());
}

}  // namespace
}  // namespace reckon
