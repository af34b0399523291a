// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/local_strain.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "reckon/analysis/delaunay.hpp"
#include "reckon/analysis/force_distribution.hpp"
#include "reckon/avatar/descriptors.hpp"
#include "reckon/avatar/predicates.hpp"
#include "reckon/core/random.hpp"
#include "reckon/math/rotation.hpp"

namespace reckon {
namespace {

std::vector<Vec3> cloud(std::size_t count, double flatness = 1) {
  RandomStream random{7, RandomPurpose::other, 3};
  std::vector<Vec3> points;
  for (std::size_t n = 0; n < count; ++n) {
    points.push_back(
        {random.uniform(-1, 1), random.uniform(-1, 1) + 5, flatness * random.uniform(-1, 1)});
  }
  return points;
}
/// Every inner sphere of eight neighbours has all of them on it: nothing but equals.
std::vector<Vec3> lattice(int edge) {
  std::vector<Vec3> points;
  for (int n = 0; n < edge * edge * edge; ++n) {
    const int row = n / edge;
    const int layer = row / edge;
    points.push_back({0.1 * (n % edge), 0.1 * (row % edge), 0.1 * layer});
  }
  return points;
}

double volume_of(const std::vector<Vec3>& points, const Tetrahedron& cell) {
  return dot(cross(points[cell[1]] - points[cell[0]], points[cell[2]] - points[cell[0]]),
             points[cell[3]] - points[cell[0]]) /
         6;
}

TEST(Delaunay, CellsFillTheHullWithoutOverlap) {
  for (const auto& points : {cloud(300), cloud(200, 1e-3), lattice(5)}) {
    double sum = 0;
    for (const Tetrahedron& cell : delaunay(points)) {
      ASSERT_EQ(orientation(points[cell[0]], points[cell[1]], points[cell[2]], points[cell[3]]), 1);
      sum += volume_of(points, cell);
    }
    // Far corners cut slivers off the hull; the hull's own tolerance does so too.
    EXPECT_NEAR(sum / convex_hull_volume(points), 1, 5e-3);
  }
}

TEST(Delaunay, EveryPlaceIsInOneCell) {
  for (const auto& points : {cloud(300), cloud(200, 1e-3), lattice(5)}) {
    const std::vector<Tetrahedron> cells = delaunay(points);
    RandomStream random{1, RandomPurpose::other, 4};
    Vec3 middle;
    for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
    for (int n = 0; n < 500; ++n) {
      const auto& towards = points[static_cast<std::size_t>(random.uniform(0, 1) *
                                                            static_cast<double>(points.size()))];
      // Off the planes of symmetry, on which faces lie.
      const Vec3 aside{random.uniform(0, 1e-4), random.uniform(0, 1e-4), random.uniform(0, 1e-6)};
      const Vec3 place = middle + random.uniform(0, 0.9) * (towards - middle) + aside;
      int around = 0;
      for (const Tetrahedron& cell : cells) {
        bool inside = true;
        for (std::size_t face = 0; face < 4; ++face) {
          std::array<Vec3, 4> p;
          for (std::size_t corner = 0; corner < 4; ++corner) p[corner] = points[cell[corner]];
          p[face] = place;
          inside = inside && orientation(p[0], p[1], p[2], p[3]) > 0;
        }
        around += inside ? 1 : 0;
      }
      ASSERT_EQ(around, 1);
    }
  }
}

TEST(Delaunay, NoSphereThroughCornersHoldsAPoint) {
  const std::vector<Vec3> points = cloud(300);
  const std::vector<Tetrahedron> cells = delaunay(points);
  EXPECT_GT(cells.size(), 1500U);
  for (const Tetrahedron& cell : cells) {
    // The centre c solves 2 (p_n - p_0) . c = |p_n|^2 - |p_0|^2.
    const Vec3& origin = points[cell[0]];
    const Vec3 a = points[cell[1]] - origin;
    const Vec3 b = points[cell[2]] - origin;
    const Vec3 c = points[cell[3]] - origin;
    const Vec3 centre = (squared_norm(a) * cross(b, c) + squared_norm(b) * cross(c, a) +
                         squared_norm(c) * cross(a, b)) /
                        (2 * dot(a, cross(b, c)));
    for (const Vec3& p : points) {
      ASSERT_GT(norm(p - origin - centre), norm(centre) * (1 - 1e-9));
    }
  }
}

TEST(Delaunay, CoincidentAndTooFewPointsAreNoTrouble) {
  std::vector<Vec3> points = cloud(30);
  const std::size_t cells = delaunay(points).size();
  points.insert(points.end(), points.begin(), points.begin() + 10);
  EXPECT_EQ(delaunay(points).size(), cells);
  EXPECT_TRUE(delaunay(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).empty());
  EXPECT_TRUE(
      delaunay(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}).empty());
}

TEST(LocalStrain, AffineMotionIsItsStrainAtEveryGrain) {
  const std::vector<Vec3> before = cloud(200);
  const Mat3 turn = rotation_matrix(normalized(Quaternion{0.7, 0.2, -0.5, 0.3}));
  const Mat3 stretch{{std::exp(0.02), 0, 0}, {0, std::exp(0.02), 0}, {0, 0, std::exp(-0.1)}};
  std::vector<Vec3> after;
  for (const Vec3& p : before) after.push_back(turn * (stretch * p) + Vec3{3, 2, 1});
  // Deviator (0.04, 0.04, -0.08): sqrt(2/3 * 0.0096).
  for (const LocalStrain& strain : local_strain(before, after, 10)) {
    ASSERT_TRUE(strain.is_known());
    EXPECT_NEAR(strain.volumetric, 0.06, 1e-9);
    EXPECT_NEAR(strain.shear, 0.08, 1e-9);
  }
}

TEST(LocalStrain, ASlipShowsAtItsPlaneAlone) {
  const std::vector<Vec3> before = cloud(2000);
  std::vector<Vec3> after = before;
  for (Vec3& p : after) {
    if (p.z > 0) p.x += 0.05;
  }
  const auto strains = local_strain(before, after, 0.6);
  double near = 0;
  double far = 0;
  for (std::size_t n = 0; n < before.size(); ++n) {
    if (!strains[n].is_known()) continue;
    double& worst = std::abs(before[n].z) > 0.6 ? far : near;
    worst = std::max(worst, strains[n].shear);
  }
  EXPECT_GT(near, 0.1);
  EXPECT_LT(far, 1e-9);
}

TEST(LocalStrain, LongTetrahedraDoNotCount) {
  std::vector<Vec3> points = cloud(100);
  points.push_back({50, 0, 0});
  const auto strains = local_strain(points, points, 2);
  EXPECT_FALSE(strains.back().is_known());
  EXPECT_TRUE(strains.front().is_known());
  EXPECT_NEAR(strains.front().shear, 0, 1e-12);
}

TEST(ForceDistribution, IsADensityOfForceOverMean) {
  const std::vector<double> sizes{1, 1, 2, 4, 0};  // no force is no contact
  const ForceDistribution found = force_distribution(sizes, 0.5);
  EXPECT_EQ(found.count, 4U);
  EXPECT_EQ(found.mean, 2);
  EXPECT_EQ(found.bins, (std::vector<std::uint64_t>{0, 2, 1, 0, 1}));
  double all = 0;
  for (std::size_t bin = 0; bin < found.bins.size(); ++bin) all += found.density(bin) * 0.5;
  EXPECT_DOUBLE_EQ(all, 1);
  EXPECT_EQ(found.middle(1), 0.75);
  EXPECT_EQ(force_distribution({}, 0.1).count, 0U);
}

}  // namespace
}  // namespace reckon
