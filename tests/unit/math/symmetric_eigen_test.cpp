// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/math/symmetric_eigen.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reckon/core/random.hpp"

namespace reckon {
namespace {

Mat3 symmetric(double xx, double yy, double zz, double xy, double xz, double yz) {
  return {{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}};
}

/// A v = lambda v, v orthonormal, values ascending; errors relative to the largest component.
void expect_eigen(const Mat3& matrix, double scale) {
  const SymmetricEigen found = symmetric_eigen(matrix);
  EXPECT_LE(found.values.x, found.values.y);
  EXPECT_LE(found.values.y, found.values.z);
  const Vec3 rows[] = {found.vectors.row_x, found.vectors.row_y, found.vectors.row_z};
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(norm(matrix * rows[i] - found.values[i] * rows[i]), 4e-15 * scale);
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(dot(rows[i], rows[j]), i == j ? 1 : 0, 2e-15);
  }
}

TEST(SymmetricEigen, SolvesRandomMatrices) {
  RandomStream random{1, RandomPurpose::other, 0};
  const auto component = [&] { return random.uniform(-1, 1); };
  for (int n = 0; n < 5000; ++n) {
    const double xx = component();
    const double yy = component();
    const double zz = component();
    const double xy = component();
    const double xz = component();
    expect_eigen(symmetric(xx, yy, zz, xy, xz, component()), 1);
  }
}

TEST(SymmetricEigen, SolvesHardMatrices) {
  expect_eigen(symmetric(1, 2, 3, 0, 0, 0), 3);
  expect_eigen(symmetric(2, 2, 2, 0, 0, 0), 2);
  expect_eigen(symmetric(2, 2, 2, 1, 1, 1), 4);              // a double eigenvalue
  expect_eigen(symmetric(1, 1, 1, 1e-9, -1e-12, 1e-15), 1);  // nearly a triple one
  expect_eigen(symmetric(1, 1, 1, 1e-200, 1e-300, 0), 1);
  expect_eigen(symmetric(1e15, 1, 1e-15, 1, 1e-3, 1e-9), 1e15);
  expect_eigen(symmetric(1e-16, 2e-16, 3e-16, 1e-17, 1e-16, -2e-17), 4e-16);
  expect_eigen(symmetric(0, 0, 0, 0, 0, 0), 1);
  expect_eigen(symmetric(0, 0, 0, 1, 0, 0), 1);
}

TEST(SymmetricEigen, HasTheseValues) {
  // Tridiagonal with 2 on and -1 beside the diagonal: 2 - 2 cos(k pi / 4).
  const Vec3 values = symmetric_eigen(symmetric(2, 2, 2, -1, 0, -1)).values;
  EXPECT_NEAR(values.x, 2 - std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(values.y, 2, 1e-15);
  EXPECT_NEAR(values.z, 2 + std::sqrt(2.0), 1e-15);
}

}  // namespace
}  // namespace reckon
