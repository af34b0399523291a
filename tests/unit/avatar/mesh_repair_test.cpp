// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/mesh_repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "expect_error.hpp"
#include "grids.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/mesh_parts.hpp"
#include "reckon/avatar/mesh_validation.hpp"
#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/core/random.hpp"
#include "test_meshes.hpp"

namespace reckon {
namespace {

TriangleMesh moved(TriangleMesh mesh, const Vec3& shift) {
  for (Vec3& v : mesh.vertices) v += shift;
  return mesh;
}

/// Every triangle with corners of its own, each off by up to `noise`.
TriangleMesh soup(const TriangleMesh& mesh, double noise) {
  RandomStream random{5, RandomPurpose::other, 0};
  TriangleMesh result;
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    for (const std::uint32_t v : t) {
      const double x = random.uniform(-noise, noise);
      const double y = random.uniform(-noise, noise);
      result.vertices.push_back(mesh.vertices[v] + Vec3{x, y, random.uniform(-noise, noise)});
    }
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

/// Without the triangles whose middle `cut` picks.
TriangleMesh without(TriangleMesh mesh, const std::function<bool(const Vec3&)>& cut) {
  std::erase_if(mesh.triangles, [&](const TriangleMesh::Triangle& t) {
    return cut((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  });
  return mesh;
}

void expect_closed(const TriangleMesh& mesh, double volume, double tolerance) {
  ASSERT_NO_THROW(require_closed_surface(mesh, "repaired"));
  EXPECT_NEAR(enclosed_volume(mesh) / volume, 1, tolerance);
}

TEST(MergeCorners, JoinsWhatDiffersByRounding) {
  const TriangleMesh ball = geodesic_sphere(6);
  const double volume = enclosed_volume(ball);
  const MergedCorners joined = merge_corners(soup(ball, 1e-6));
  EXPECT_EQ(joined.mesh.vertices.size(), ball.vertices.size());
  EXPECT_EQ(joined.merged, 3 * ball.triangles.size() - ball.vertices.size());
  EXPECT_LT(joined.largest_distance, 2e-6 * std::sqrt(3));
  EXPECT_EQ(joined.lost_triangles, 0U);
  expect_closed(joined.mesh, volume, 1e-5);
  // Far from the origin single precision leaves more.
  TriangleMesh far = soup(moved(ball, {1000, 0, 0}), 0);
  RandomStream random{7, RandomPurpose::other, 0};
  for (Vec3& v : far.vertices)
    v.x = static_cast<double>(static_cast<float>(v.x + 1e-5 * random.uniform()));
  expect_closed(merge_corners(far).mesh, volume, 1e-3);
  // A given distance reaches further; without it these corners stay apart.
  const TriangleMesh rough = soup(ball, 1e-3);
  EXPECT_THROW(require_closed_surface(merge_corners(rough).mesh, ""), Error);
  expect_closed(merge_corners(rough, 5e-3).mesh, volume, 0.01);
}

TEST(MergeCorners, LeavesAClosedSurfaceAsItIs) {
  TriangleMesh pin = geodesic_sphere(4);
  for (Vec3& v : pin.vertices) v = 1e-7 * v;  // detail far below the distance
  const TriangleMesh both = test::together(test::cube(-3, -1), pin);
  const MergedCorners joined = merge_corners(both);
  EXPECT_EQ(joined.merged, 0U);
  EXPECT_EQ(joined.mesh.vertices.size(), both.vertices.size());
}

TEST(MeshRepair, ClosesHolesAndSaysSo) {
  const TriangleMesh ball = geodesic_sphere(12);
  const double volume = enclosed_volume(ball);
  // One triangle, a cap below (as of a table that the grain lay on), and both at once.
  const auto below = [](const Vec3& p) { return p.z < -0.9; };
  TriangleMesh mesh = ball;
  mesh.triangles.erase(mesh.triangles.begin() + 17);
  MeshRepair repair = repair_mesh(mesh, "scan");
  ASSERT_EQ(repair.holes.size(), 1U);
  EXPECT_EQ(repair.holes[0].edges, 3U);
  EXPECT_EQ(mesh.triangles.size(), ball.triangles.size());
  expect_closed(mesh, volume, 1e-12);

  mesh = without(ball, below);
  mesh.triangles.erase(mesh.triangles.begin() + 17);
  repair = repair_mesh(mesh, "scan");
  ASSERT_EQ(repair.holes.size(), 2U);
  // The cap below z = -h of a unit ball has the volume pi (1 - h)^2 (2 + h) / 3, and its base the
  // area pi (1 - h^2).
  const double cap = M_PI * 0.1 * 0.1 * 2.9 / 3;
  expect_closed(mesh, volume - cap, 0.01);
  const double closed = std::max(repair.holes[0].area, repair.holes[1].area);
  EXPECT_NEAR(closed, M_PI * (1 - 0.9 * 0.9), 0.15);
  EXPECT_NEAR(repair.surface_area, surface_area(mesh), 1e-12);
  const std::vector<std::string> text = repair.text();
  ASSERT_EQ(text.size(), 1U);
  EXPECT_TRUE(text[0].starts_with("closed 2 holes, the longest of ")) << text[0];
}

TEST(MeshRepair, LongBordersAreClosedToo) {
  const auto below = [](const Vec3& p) { return p.z < -0.5; };
  TriangleMesh mesh = without(geodesic_sphere(70), below);
  const MeshRepair repair = repair_mesh(mesh, "scan");
  ASSERT_EQ(repair.holes.size(), 1U);
  EXPECT_GT(repair.holes[0].edges, 300U);
  expect_closed(mesh, 4 * M_PI / 3 - M_PI * 0.25 * 2.5 / 3, 0.01);
}

TEST(MeshRepair, RemovesLooseFragmentsAndDoubledTriangles) {
  const TriangleMesh ball = geodesic_sphere(8);
  TriangleMesh mesh = ball;
  for (int n = 0; n < 5; ++n) {
    TriangleMesh crumb = geodesic_sphere(1);
    for (Vec3& v : crumb.vertices) v = 0.05 * v + Vec3{1.2 + 0.2 * n, 0, 0};
    if (n < 3) crumb.triangles.resize(4);  // open shells
    mesh = test::together(mesh, crumb);
  }
  mesh.triangles.push_back(mesh.triangles[3]);
  const MeshRepair repair = repair_mesh(mesh, "scan");
  EXPECT_EQ(repair.fragments, 5U);
  EXPECT_EQ(repair.doubled_triangles, 1U);
  EXPECT_TRUE(repair.holes.empty());
  EXPECT_EQ(mesh.triangles.size(), ball.triangles.size());
  expect_closed(mesh, enclosed_volume(ball), 1e-12);
}

TEST(MeshRepair, TurnsTrianglesOutward) {
  const TriangleMesh ball = geodesic_sphere(5);
  TriangleMesh mesh = ball;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  }
  const std::size_t turned = (mesh.triangles.size() + 2) / 3;
  EXPECT_EQ(repair_mesh(mesh, "scan").turned_triangles, turned);
  expect_closed(mesh, enclosed_volume(ball), 1e-12);
  for (TriangleMesh::Triangle& t : mesh.triangles) std::swap(t[0], t[1]);  // inside out
  EXPECT_EQ(repair_mesh(mesh, "scan").turned_triangles, mesh.triangles.size());
  expect_closed(mesh, enclosed_volume(ball), 1e-12);
  EXPECT_TRUE(repair_mesh(mesh, "scan").text().empty()) << "nothing is left to do";
}

// A face split on one side of an edge and not on the other leaves a slit without area.
TEST(MeshRepair, ClosesSlits) {
  TriangleMesh mesh = test::cube();
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0.5, 0, 0});  // on the edge from vertex 0 to vertex 1
  const auto found =
      std::find(mesh.triangles.begin(), mesh.triangles.end(), TriangleMesh::Triangle{0, 1, 5});
  ASSERT_NE(found, mesh.triangles.end());
  *found = {0, middle, 5};
  mesh.triangles.push_back({middle, 1, 5});
  EXPECT_THROW(require_closed_surface(mesh, ""), Error);
  const MeshRepair repair = repair_mesh(mesh, "cad");
  EXPECT_EQ(repair.holes.size(), 1U);
  EXPECT_EQ(repair.flat_triangles, 1U);
  expect_closed(mesh, 1, 1e-12);
}

// Two sheets that share one corner, as at the border of a photogrammetry scan.
TEST(MeshRepair, OpensPinchedBorders) {
  TriangleMesh mesh = without(geodesic_sphere(10), [](const Vec3& p) { return p.z < -0.7; });
  // An extra triangle that shares one corner of the border only.
  std::uint32_t lowest = 0;
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      if (mesh.vertices[v].z < mesh.vertices[lowest].z) lowest = v;
    }
  }
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  ASSERT_TRUE(used[lowest]);
  const auto extra = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back(mesh.vertices[lowest] + Vec3{0.05, 0, -0.2});
  mesh.vertices.push_back(mesh.vertices[lowest] + Vec3{-0.05, 0, -0.2});
  mesh.triangles.push_back({lowest, extra, extra + 1});
  const MeshRepair repair = repair_mesh(mesh, "scan");
  EXPECT_EQ(repair.fragments + repair.pinched_triangles, 1U);
  expect_closed(mesh, 4 * M_PI / 3, 0.1);
}

// A grid may hold a void or a crumb where the grain has a narrow crevice.
TEST(MeshParts, TheLargestPartLeavesVoidsAndCrumbsOut) {
  const LevelSet grid = test::cube_grid(1.5, 30, {}, [](const Vec3& p) {
    const double ball = norm(p) - 1;
    const double hollow = 0.25 - norm(p - Vec3{0.4, 0, 0});
    const double crumb = norm(p - Vec3{1.2, 0, 0}) - 0.12;
    return std::min(std::max(ball, hollow), crumb);
  });
  const TriangleMesh surface = extract_surface(grid);
  EXPECT_THROW(require_closed_surface(surface, ""), Error);
  const LargestPart part = largest_part(surface);
  EXPECT_EQ(part.others, 2U);
  expect_closed(part.mesh, 4 * M_PI / 3, 0.02);
  EXPECT_NEAR(part.others_volume, std::pow(0.25, 3) + std::pow(0.12, 3), 5e-3);
}

TEST(MeshParts, EachSolidOfAMeshBecomesOne) {
  const TriangleMesh three =
      test::together(test::together(test::cube(0, 1), moved(test::cube(0, 2), {5, 0, 0})),
                     moved(test::cube(0, 3), {0, 9, 0}));
  const std::vector<SolidPart> parts = separate_solids(three, "heap");
  ASSERT_EQ(parts.size(), 3U);
  EXPECT_NEAR(enclosed_volume(parts[0].mesh), 1, 1e-12);
  EXPECT_NEAR(enclosed_volume(parts[1].mesh), 8, 1e-12);
  EXPECT_NEAR(enclosed_volume(parts[2].mesh), 27, 1e-12);
  EXPECT_EQ(separate_solids(test::cube(), "one").size(), 1U);

  const auto refused = [](const TriangleMesh& mesh, std::initializer_list<std::string> texts) {
    test::expect_error([&] { (void)separate_solids(mesh, "heap"); }, texts);
  };
  refused(test::together(test::cube(0, 3), test::cube(1, 2)), {"part 2", "inside part 1"});
  refused(test::together(test::cube(0, 3), test::cube(2, 5)), {"touches or crosses"});
}

TEST(MeshParts, OneBadPartLeavesTheOthers) {
  const auto second_fault = [](const TriangleMesh& mesh) -> std::string {
    const std::vector<SolidPart> parts = separate_solids(mesh, "heap");
    EXPECT_EQ(parts.size(), 2U);
    EXPECT_FALSE(parts[0].fault);
    return parts[1].fault ? parts[1].fault->what() : "no fault";
  };
  TriangleMesh cavity = test::cube(1, 2);
  for (TriangleMesh::Triangle& t : cavity.triangles) std::swap(t[0], t[1]);
  EXPECT_TRUE(second_fault(test::together(test::cube(0, 3), cavity))
                  .starts_with("heap, part 2: the triangles face inward"));
  TriangleMesh open = test::together(test::cube(0, 1), test::cube(4, 5));
  open.triangles.pop_back();
  EXPECT_TRUE(second_fault(open).starts_with("heap, part 2: the surface is open"));
}

}  // namespace
}  // namespace reckon
