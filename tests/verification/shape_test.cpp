// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shapes of solids with known volume, inertia and area, at growing resolution. With
// RECKON_VERIFICATION_OUT set, the errors go to shape_grid_*.csv and shape_nodes_*.csv.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "../support/verification_table.hpp"
#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/distance_transform.hpp"
#include "reckon/avatar/grid_mass.hpp"
#include "reckon/avatar/shape_sources.hpp"
#include "reckon/avatar/surface_extraction.hpp"

namespace reckon {
namespace {

using std::numbers::pi;

/// A solid and what is known about it; moments over density, ascending.
struct Solid {
  std::string name;
  ShapeSource source;
  double volume;
  Vec3 inertia;
  double area;
};

Solid sphere() {
  const double volume = 4 * pi / 3;
  return {"sphere", solid_source("sphere", 2, [](double edge) { return sphere_mesh(1, edge); }),
          volume, 0.4 * volume * Vec3{1, 1, 1}, 4 * pi};
}
Solid ellipsoid() {
  const double volume = 4 * pi / 3 * 0.7 * 0.5;
  // Area of the ellipsoid with half axes 1, 0.7, 0.5, by its elliptic integrals.
  const double phi = std::acos(0.5);
  const double k = std::sqrt((0.49 - 0.25) / (0.49 * (1 - 0.25)));
  const double area =
      2 * pi * 0.25 + 2 * pi * 0.7 / std::sin(phi) *
                          (std::ellint_2(k, phi) * (1 - 0.25) + std::ellint_1(k, phi) * 0.25);
  return {"ellipsoid",
          solid_source("ellipsoid", 2,
                       [](double edge) {
                         return ellipsoid_mesh({1, 0.7, 0.5}, edge);
                       }),
          volume, volume / 5 * Vec3{0.49 + 0.25, 1 + 0.25, 1 + 0.49}, area};
}
Solid superellipsoid() {
  const auto mesh = [](double edge) {
    return superellipsoid_mesh({{0.4, 1, 0.8}, 0.4, 1.6}, edge);
  };
  // The area has no closed form: a mesh finer than any grid here, its error removed once more by
  // Richardson's extrapolation.
  const double fine = solid_properties(mesh(0.02)).surface_area;
  const double finer = solid_properties(mesh(0.01)).surface_area;
  return {"superellipsoid",
          solid_source("superellipsoid", 2, mesh, SurfaceKind::curved),
          1.0864027,
          {0.128351, 0.262462, 0.318410},
          finer + (finer - fine) / 3};
}
Solid box() {
  const double volume = 2 * 1.4 * 1;
  return {"box",
          solid_source("box", 2,
                       [](double edge) {
                         return box_mesh({1, 0.7, 0.5}, edge);
                       }),
          volume, volume / 12 * Vec3{1.96 + 1, 4 + 1, 4 + 1.96}, 2 * (2.8 + 2 + 1.4)};
}

double largest_relative_error(const Vec3& found, const Vec3& expected) {
  double worst = 0;
  for (int axis = 0; axis < 3; ++axis) {
    worst = std::max(worst, std::abs(found[axis] / expected[axis] - 1));
  }
  return worst;
}

double relative_error(double found, double expected) { return std::abs(found / expected - 1); }

struct GridErrors {
  double voxels{0};
  double volume{0};          // stored
  double inertia{0};         // stored
  double area{0};            // stored
  double counted_volume{0};  // smoothed counting on the grid of distances
  double counted_inertia{0};
  double plain_volume{0};    // plain counting on the grid
  double contact_volume{0};  // inside the interpolated zero surface, used by contacts
  double contact_area{0};
  double gradient{0};  // mean of | |gradient| - 1 | at the nodes
};

GridErrors grid_errors(const Solid& solid, double voxels) {
  const std::vector<ShapeSource> sources{solid.source};
  const Shape shape = build_library(sources, {.voxels_per_diameter = voxels})[0];
  const LevelSetView grid{shape.level_set};
  const TriangleMesh mesh =
      to_principal_frame(solid.source.surface({.voxels_per_diameter = voxels}));
  const LevelSet distances = transformed_distance(mesh, TriangleBvh{mesh}, shape.level_set.spacing);
  const SolidProperties counted = grid_properties(distances);
  const SolidProperties contact = solid_properties(extract_surface(grid));
  double gradient = 0;
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    gradient += std::abs(norm(grid.sample(shape.nodes.position(n)).gradient_body) - 1);
  }
  const Vec3 counted_moments{counted.inertia.row_x.x, counted.inertia.row_y.y,
                             counted.inertia.row_z.z};
  return {voxels,
          relative_error(shape.mass.volume, solid.volume),
          largest_relative_error(shape.mass.inertia, solid.inertia),
          relative_error(shape.descriptors.surface_area, solid.area),
          relative_error(counted.volume, solid.volume),
          largest_relative_error(counted_moments, solid.inertia),
          relative_error(plain_grid_volume(distances), solid.volume),
          relative_error(contact.volume, solid.volume),
          relative_error(contact.surface_area, solid.area),
          gradient / static_cast<double>(shape.nodes.size())};
}

std::vector<GridErrors> refine(const Solid& solid) {
  testing::VerificationTable table{
      "shape_grid_" + solid.name,
      "voxels_per_diameter,volume,inertia,area,counted_volume,counted_inertia,plain_volume,"
      "contact_volume,contact_area,gradient"};
  std::vector<GridErrors> all;
  for (const double voxels : {10.0, 14.0, 20.0, 28.0, 40.0}) {
    const GridErrors e = grid_errors(solid, voxels);
    table.row({e.voxels, e.volume, e.inertia, e.area, e.counted_volume, e.counted_inertia,
               e.plain_volume, e.contact_volume, e.contact_area, e.gradient});
    all.push_back(e);
  }
  return all;
}

/// The slope of log(error) over log(spacing), by least squares.
double order(const std::vector<GridErrors>& all, double GridErrors::*error) {
  double sx = 0;
  double sy = 0;
  double sxx = 0;
  double sxy = 0;
  for (const GridErrors& e : all) {
    const double x = -std::log(e.voxels);
    const double y = std::log(e.*error);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  const auto n = static_cast<double>(all.size());
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// What the nodes of a shape make of Gauss's theorem: their areas times the level set's normals
/// close the surface and give the volume inside it.
struct NodeErrors {
  double volume{0};
  double closure{0};
};
NodeErrors node_errors(const Solid& solid, std::uint32_t nodes) {
  const std::vector<ShapeSource> sources{solid.source};
  const Shape shape = build_library(sources, {.voxels_per_diameter = 20, .node_count = nodes})[0];
  const LevelSetView grid{shape.level_set};
  double volume = 0;
  Vec3 sum;
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    const Vec3 p = shape.nodes.position(n);
    const Vec3 area = shape.nodes.area[n] * normalized(grid.sample(p).gradient_body);
    volume += dot(p, area) / 3;
    sum += area;
  }
  return {relative_error(volume, solid.volume), norm(sum) / solid.area};
}

/// `grid_limit`: what the grid alone does to the volume. Volume and closure limits hold at 100
/// nodes and fall with their number.
void refine_nodes(const Solid& solid, double grid_limit, double volume_limit,
                  double closure_limit) {
  testing::VerificationTable table{"shape_nodes_" + solid.name, "nodes,gauss_volume,closure"};
  for (const std::uint32_t nodes : {100U, 200U, 400U, 800U, 1600U}) {
    const NodeErrors e = node_errors(solid, nodes);
    table.row({static_cast<double>(nodes), e.volume, e.closure});
    EXPECT_LT(e.volume, grid_limit + volume_limit * 100 / nodes) << solid.name << ' ' << nodes;
    EXPECT_LT(e.closure, closure_limit * std::sqrt(100.0 / nodes)) << solid.name << ' ' << nodes;
  }
}

/// What holds for every smooth solid.
void expect_second_order(const std::vector<GridErrors>& all, const std::string& name) {
  EXPECT_NEAR(order(all, &GridErrors::volume), 2, 0.3) << name;
  EXPECT_NEAR(order(all, &GridErrors::inertia), 2, 0.3) << name;
  EXPECT_NEAR(order(all, &GridErrors::area), 2, 0.4) << name;
  EXPECT_NEAR(order(all, &GridErrors::contact_volume), 2, 0.3) << name;
  EXPECT_GT(order(all, &GridErrors::gradient), 0.8) << name;
  for (const GridErrors& e : all) {
    EXPECT_LT(e.volume, 0.5 / (e.voxels * e.voxels)) << name << ' ' << e.voxels;
    EXPECT_LT(e.counted_volume, 0.6 / (e.voxels * e.voxels)) << name << ' ' << e.voxels;
    EXPECT_LT(e.contact_volume, 0.6 / (e.voxels * e.voxels)) << name << ' ' << e.voxels;
  }
}

TEST(ShapeConvergence, Sphere) { expect_second_order(refine(sphere()), "sphere"); }

TEST(ShapeConvergence, Ellipsoid) { expect_second_order(refine(ellipsoid()), "ellipsoid"); }

TEST(ShapeConvergence, Superellipsoid) {
  const auto all = refine(superellipsoid());
  EXPECT_GT(order(all, &GridErrors::volume), 1.6);
  EXPECT_GT(order(all, &GridErrors::inertia), 1.6);
  EXPECT_GT(order(all, &GridErrors::contact_volume), 1.5);
  EXPECT_LT(all.back().volume, 5e-4);
  EXPECT_LT(all.back().inertia, 1e-3);
  EXPECT_LT(all.back().area, 1e-3);
}

TEST(ShapeConvergence, Box) {
  const auto all = refine(box());
  for (const GridErrors& e : all) {
    EXPECT_LT(e.volume, 1e-10);
    EXPECT_LT(e.inertia, 1e-10);
    EXPECT_LT(e.area, 1e-10);
    EXPECT_LT(e.counted_volume, 2 / (e.voxels * e.voxels));
  }
  // Trilinear interpolation bevels the edges by a length of order h: h^2 in volume, h in area.
  EXPECT_GT(order(all, &GridErrors::contact_volume), 1.5);
  EXPECT_LT(all.back().contact_volume, 5e-3);
  EXPECT_LT(all.back().contact_area, 0.03);
}

TEST(NodeAreaConvergence, Sphere) { refine_nodes(sphere(), 0.002, 0.01, 0.01); }
TEST(NodeAreaConvergence, Ellipsoid) { refine_nodes(ellipsoid(), 0.002, 0.02, 0.01); }
TEST(NodeAreaConvergence, Superellipsoid) { refine_nodes(superellipsoid(), 0.01, 0.05, 0.03); }
// Nodes on edges count with the area of one face, so that here the box is taken for one that only a
// grid knows. Nodes closer than a voxel lie on the bevels that the grid makes of edges, with
// slanted normals. The closure of few nodes on a box scatters with the place where spreading
// begins: 0.02 to 0.035 was seen at 100.
TEST(NodeAreaConvergence, Box) {
  Solid sampled = box();
  sampled.source.kind = SurfaceKind::sampled;
  refine_nodes(sampled, 0.08, 0.05, 0.05);
}

}  // namespace
}  // namespace reckon
