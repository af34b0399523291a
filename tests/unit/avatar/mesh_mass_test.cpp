// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/mesh_mass.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test_meshes.hpp"

namespace reckon {
namespace {

TriangleMesh brick(const Vec3& half) {
  TriangleMesh mesh = test::cube(-1, 1);
  for (Vec3& v : mesh.vertices) v = hadamard(v, half);
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Quaternion& turn, const Vec3& shift) {
  const Mat3 rotation = rotation_matrix(turn);
  for (Vec3& v : mesh.vertices) v = rotation * v + shift;
  return mesh;
}

// I = m (b^2 + c^2) / 12 with edges 2 * half.
Vec3 brick_moments(const Vec3& half) {
  const double volume = 8 * half.x * half.y * half.z;
  return (volume / 3) * Vec3{half.y * half.y + half.z * half.z, half.x * half.x + half.z * half.z,
                             half.x * half.x + half.y * half.y};
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(SolidProperties, OfABrickAnywhere) {
  const Vec3 half{3, 2, 1};
  const Vec3 shift{10, -20, 5};
  const SolidProperties solid = solid_properties(moved(brick(half), {}, shift));
  EXPECT_NEAR(solid.volume, 48, 1e-12);
  EXPECT_NEAR(solid.surface_area, 88, 1e-12);
  expect_near(solid.centroid, shift, 1e-13);
  const Vec3 expected = brick_moments(half);
  expect_near(solid.inertia.row_x, {expected.x, 0, 0}, 1e-11);
  expect_near(solid.inertia.row_y, {0, expected.y, 0}, 1e-11);
  expect_near(solid.inertia.row_z, {0, 0, expected.z}, 1e-11);
}

// The corner tetrahedron x + y + z <= 1: I_xx = 2/60 - 2 V (1/4)^2 and I_xy = -(1/120 - V/16).
TEST(SolidProperties, OfATetrahedronWithProducts) {
  const SolidProperties solid =
      solid_properties(test::tetrahedron({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
  EXPECT_NEAR(solid.volume, 1.0 / 6, 1e-16);
  expect_near(solid.centroid, {0.25, 0.25, 0.25}, 1e-15);
  const double diagonal = 2.0 / 60 - 2.0 / 6 / 16;
  const double mixed = -(1.0 / 120 - 1.0 / 6 / 16);
  expect_near(solid.inertia.row_x, {diagonal, mixed, mixed}, 1e-16);
  expect_near(solid.inertia.row_y, {mixed, diagonal, mixed}, 1e-16);
  expect_near(solid.inertia.row_z, {mixed, mixed, diagonal}, 1e-16);
}

TEST(SolidProperties, FarFromTheOriginKeepsItsDigits) {
  const Vec3 half{0.003, 0.002, 0.001};
  const SolidProperties solid = solid_properties(moved(brick(half), {}, {100, 100, 100}));
  // Coordinates of 100 m are rounded to 1.4e-14 m, 1e-11 of the brick.
  EXPECT_NEAR(solid.volume / 48e-9, 1, 1e-10);
  EXPECT_NEAR(solid.inertia.row_x.x / brick_moments(half).x, 1, 1e-10);
  EXPECT_NEAR(solid.inertia.row_x.y / brick_moments(half).x, 0, 1e-10);
}

TEST(PrincipalFrame, UndoesAnyRotation) {
  const Vec3 half{1, 2, 3};
  const Quaternion turn = normalized(Quaternion{0.3, -0.5, 0.4, 0.7});
  const TriangleMesh mesh = moved(brick(half), turn, {4, 5, 6});
  const PrincipalFrame frame = principal_frame(solid_properties(mesh));
  const Vec3 moments = brick_moments(half);
  expect_near(frame.moments, {moments.z, moments.y, moments.x}, 1e-11);
  EXPECT_NEAR(dot(cross(frame.rotation.row_x, frame.rotation.row_y), frame.rotation.row_z), 1,
              1e-14);
  const TriangleMesh body = to_principal_frame(mesh);
  for (const Vec3& v : body.vertices) {
    expect_near({std::abs(v.x), std::abs(v.y), std::abs(v.z)}, {3, 2, 1}, 1e-13);
  }
  const SolidProperties solid = solid_properties(body);
  expect_near(solid.centroid, {}, 1e-14);
  expect_near(solid.inertia.row_x, {frame.moments.x, 0, 0}, 1e-11);
  expect_near(solid.inertia.row_y, {0, frame.moments.y, 0}, 1e-11);
  EXPECT_NEAR(solid.volume, 48, 1e-12);
}

TEST(PrincipalFrame, LeavesAMeshInItsFrameAlone) {
  const PrincipalFrame frame = principal_frame(solid_properties(brick({3, 2, 1})));
  expect_near(frame.rotation.row_x, {1, 0, 0}, 1e-15);
  expect_near(frame.rotation.row_y, {0, 1, 0}, 1e-15);
  expect_near(frame.rotation.row_z, {0, 0, 1}, 1e-15);
}

TEST(PrincipalFrame, EqualMomentsKeepTheMeshsAxes) {
  const auto rotation = [](const Vec3& half) {
    return principal_frame(solid_properties(brick(half))).rotation;
  };
  EXPECT_EQ(rotation({1, 1, 1}), Mat3{});
  const Mat3 flat = rotation({2, 2, 1});  // free about z
  expect_near(flat.row_x, {1, 0, 0}, 1e-15);
  expect_near(flat.row_y, {0, 1, 0}, 1e-15);
  const Mat3 upright = rotation({1, 1, 2});  // free about z, which becomes body x
  expect_near(upright.row_x, {0, 0, 1}, 1e-15);
  expect_near(upright.row_y, {1, 0, 0}, 1e-15);
  expect_near(upright.row_z, {0, 1, 0}, 1e-15);
}

}  // namespace
}  // namespace reckon
