// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/mesh_validation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "expect_error.hpp"
#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/mesh_reader.hpp"
#include "reckon/avatar/self_intersection.hpp"
#include "reckon/core/random.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

void expect_refused(const TriangleMesh& mesh, std::initializer_list<std::string> parts) {
  test::expect_error([&] { require_closed_surface(mesh, "grain.stl"); }, {"grain.stl: "});
  test::expect_error([&] { require_closed_surface(mesh, "grain.stl"); }, parts);
}

TriangleMesh shifted(TriangleMesh mesh, const Vec3& shift) {
  for (Vec3& v : mesh.vertices) v += shift;
  return mesh;
}

TEST(ClosedSurface, GoodMeshesPass) {
  for (const TriangleMesh& mesh :
       {test::cube(), geodesic_sphere(12), box_mesh({1, 2, 3}, 0.3), cylinder_mesh(1, 0.5, 0.1),
        superellipsoid_mesh({{0.4, 1, 0.8}, 0.4, 1.6}, 0.05),
        ellipsoid_mesh({1e-3, 2e-4, 5e-4}, 1e-4)}) {
    EXPECT_NO_THROW(require_closed_surface(mesh, "good"));
  }
}

TEST(ClosedSurface, RealGrainsPass) {
  const std::filesystem::path folder = RECKON_SOURCE_DIR "/../shared/data/aggregate57/stl";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no measured grains in " << folder;
  for (const auto& entry : std::filesystem::directory_iterator{folder}) {
    EXPECT_NO_THROW(require_closed_surface(read_mesh(entry.path(), 1e-3), entry.path().string()));
  }
}

TEST(ClosedSurface, BadNumbersAreRefused) {
  expect_refused({}, {"no triangles"});
  TriangleMesh mesh = test::cube();
  mesh.vertices[3].z = std::numeric_limits<double>::quiet_NaN();
  expect_refused(mesh, {"vertex 3", "not a finite number", "nan"});
  mesh.vertices[3].z = std::numeric_limits<double>::infinity();
  expect_refused(mesh, {"vertex 3", "inf"});
  mesh = test::cube();
  mesh.triangles[4][2] = 8;
  expect_refused(mesh, {"triangle 4", "vertex 8", "8 vertices"});
}

TEST(ClosedSurface, BadSizesAreRefused) {
  expect_refused(test::cube(2, 2), {"no size", "(2, 2, 2)"});
  expect_refused(test::cube(0, 1e-12), {"1e-12 m across", "unit"});
  expect_refused(test::cube(0, 1e9), {"1e+09 m across", "unit"});
  TriangleMesh mesh = test::cube();
  for (Vec3& v : mesh.vertices) v.y = v.z = 0;
  expect_refused(mesh, {"no triangle has an area", "12"});
  // A pillow without filling: closed and simple, but flat.
  expect_refused({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}, {"no volume"});
}

TEST(ClosedSurface, TrianglesWithoutAreaAreRefused) {
  // Vertex 8 halves edge 0-1; triangle (0, 8, 1) bridges it with zero height.
  TriangleMesh mesh = test::cube();
  mesh.vertices.push_back({0.5, 0, 0});
  for (TriangleMesh::Triangle& t : mesh.triangles) {
    if (t == TriangleMesh::Triangle{0, 1, 5}) t = {8, 1, 5};
  }
  mesh.triangles.push_back({0, 8, 5});
  mesh.triangles.push_back({8, 0, 1});
  expect_refused(mesh, {"1 of 14 triangles", "triangle 13", "degenerate"});
}

TEST(ClosedSurface, OpenSurfacesAreRefused) {
  TriangleMesh mesh = test::cube();
  mesh.triangles.erase(mesh.triangles.begin() + 6);
  expect_refused(mesh, {"open", "3 edges", "near (0", "Close the holes"});
  // The vertices of a soup, not welded: every edge is open.
  TriangleMesh soup;
  for (const auto& t : test::cube().triangles) {
    for (const std::uint32_t v : t) soup.vertices.push_back(test::cube().vertices[v]);
    const auto end = static_cast<std::uint32_t>(soup.vertices.size());
    soup.triangles.push_back({end - 3, end - 2, end - 1});
  }
  expect_refused(soup, {"36 edges", "--merge"});
  EXPECT_NO_THROW(require_closed_surface(welded(soup), "welded"));
}

TEST(ClosedSurface, CrowdedEdgesAreRefused) {
  // Two tetrahedra welded along an edge.
  TriangleMesh mesh =
      test::together(test::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}),
                     test::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}));
  expect_refused(welded(mesh), {"not a simple one", "1 edges", "(0.5, 0, 0)"});
}

TEST(ClosedSurface, InconsistentWindingIsRefused) {
  TriangleMesh mesh = test::cube();
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  expect_refused(mesh, {"disagree", "3 edges", "consistent"});
}

TEST(ClosedSurface, InwardSurfacesAreRefused) {
  TriangleMesh mesh = test::cube();
  for (TriangleMesh::Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  expect_refused(mesh, {"inward", "-1 m^3", "--repair"});
}

TEST(ClosedSurface, SeveralPartsAreRefused) {
  TriangleMesh mesh = test::together(test::cube(), shifted(test::cube(), {3, 0, 0}));
  expect_refused(mesh, {"2 separate parts", "near (3, "});
  mesh = test::together(mesh, shifted(test::cube(), {0, 0, 5}));
  expect_refused(mesh, {"3 separate parts"});
}

TEST(ClosedSurface, PinchedSurfacesAreRefused) {
  // One vertex of a sphere is pulled onto the one on the other side: still one part, which touches
  // itself there.
  TriangleMesh mesh = geodesic_sphere(4);
  for (TriangleMesh::Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      if (v == 3) v = 0;  // the vertices 0 and 3 of an icosahedron are opposite
    }
  }
  expect_refused(mesh, {"pinches itself at vertex 0"});
}

TEST(ClosedSurface, SelfIntersectionsAreRefused) {
  // One vertex of a sphere pushed out through the other side.
  TriangleMesh mesh = geodesic_sphere(6);
  mesh.vertices[0] = -1.5 * mesh.vertices[0];
  expect_refused(mesh, {"touches or crosses itself", "triangles "});
  // A dent that stays inside is fine.
  mesh.vertices[0] = 0.5 * mesh.vertices[0] / norm(mesh.vertices[0]);
  EXPECT_NO_THROW(require_closed_surface(mesh, "dented"));
}

TEST(ClosedSurface, AFaceFoldedOntoItsNeighbourIsRefused) {
  // The base of a pyramid has an extra vertex in its plane that is pulled outside the base.
  TriangleMesh mesh{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, 0}},
      {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}}};
  EXPECT_NO_THROW(require_closed_surface(mesh, "pyramid"));
  mesh.vertices[5] = {0.5, -0.5, 0};
  expect_refused(mesh, {"touches or crosses itself"});
}

using Polygon = std::vector<Vec3>;

/// Separating axes: two convex polygons are apart where their shadows on one of these lines are.
bool separated(const Polygon& a, const Polygon& b) {
  const auto edge = [](const Polygon& p, std::size_t n) { return p[(n + 1) % p.size()] - p[n]; };
  const Vec3 normal_a = cross(edge(a, 0), edge(a, 1));
  const Vec3 normal_b = cross(edge(b, 0), edge(b, 1));
  std::vector<Vec3> axes{normal_a, normal_b};
  for (std::size_t i = 0; i < a.size(); ++i) {
    axes.push_back(cross(normal_a, edge(a, i)));
    for (std::size_t j = 0; j < b.size(); ++j) axes.push_back(cross(edge(a, i), edge(b, j)));
  }
  for (std::size_t j = 0; j < b.size(); ++j) axes.push_back(cross(normal_b, edge(b, j)));
  return std::any_of(axes.begin(), axes.end(), [&](const Vec3& axis) {
    const auto shadow = [&](const Polygon& p) {
      std::vector<double> s;
      for (const Vec3& v : p) s.push_back(dot(axis, v));
      return std::pair{*std::min_element(s.begin(), s.end()),
                       *std::max_element(s.begin(), s.end())};
    };
    const auto [low_a, high_a] = shadow(a);
    const auto [low_b, high_b] = shadow(b);
    const double margin = 1e-12 * norm(axis);
    return low_a > high_b + margin || low_b > high_a + margin;
  });
}

TEST(TrianglesMeet, AgreesWithSeparatingAxes) {
  RandomStream random{5, RandomPurpose::other, 0};
  int meeting = 0;
  constexpr int trials = 6000;
  for (int n = 0; n < trials; ++n) {
    const bool coplanar = n % 4 == 0;
    const bool shares_corner = n % 3 == 0;
    TriangleMesh mesh;
    for (int v = 0; v < 6; ++v) {
      const double x = random.uniform();
      const double y = random.uniform();
      mesh.vertices.push_back({x, y, coplanar ? 0.5 : random.uniform()});
    }
    mesh.triangles = {{0, 1, 2}, {shares_corner ? 0U : 3U, 4, 5}};
    Polygon a{mesh.vertices[0], mesh.vertices[1], mesh.vertices[2]};
    Polygon b{mesh.vertices[mesh.triangles[1][0]], mesh.vertices[4], mesh.vertices[5]};
    if (shares_corner) {  // cut the shared corner off
      for (Polygon* p : {&a, &b}) {
        const Vec3 tip = p->front();
        p->front() = tip + 1e-6 * ((*p)[1] - tip);
        p->push_back(tip + 1e-6 * ((*p)[2] - tip));
      }
    }
    const bool expected = !separated(a, b);
    ASSERT_EQ(triangles_meet(mesh, 0, 1), expected) << n;
    ASSERT_EQ(triangles_meet(mesh, 1, 0), expected) << n;
    meeting += expected ? 1 : 0;
  }
  EXPECT_GT(meeting, trials / 10);
  EXPECT_LT(meeting, trials - trials / 10);
}

TEST(TrianglesMeet, TouchingCounts) {
  TriangleMesh mesh{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 0}, {1, 1, 1}, {2, 2, 3}},
                    {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_TRUE(triangles_meet(mesh, 0, 1));  // a corner on a face
  mesh.vertices[3].z = 1e-300;
  EXPECT_FALSE(triangles_meet(mesh, 0, 1));
  mesh.vertices[3] = {2, 2, 0};
  EXPECT_TRUE(triangles_meet(mesh, 0, 1));  // a corner on an edge
  mesh.vertices[3] = {0, 4, 0};
  EXPECT_TRUE(triangles_meet(mesh, 0, 1));  // a corner on a corner
  // Edge neighbours only share their edge, unless one is folded onto the other.
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  mesh.vertices[3] = {1, -1, 0};
  EXPECT_FALSE(triangles_meet(mesh, 0, 1));
  mesh.vertices[3] = {1, 1, 0};
  EXPECT_TRUE(triangles_meet(mesh, 0, 1));
  mesh.vertices[3] = {1, 1, 1e-300};
  EXPECT_FALSE(triangles_meet(mesh, 0, 1));
}

}  // namespace
}  // namespace reckon
