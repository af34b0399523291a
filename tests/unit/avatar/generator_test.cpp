// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/generator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "expect_error.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/mesh_validation.hpp"
#include "reckon/avatar/spherical_harmonics.hpp"
#include "reckon/avatar/triangle_bvh.hpp"

namespace reckon {
namespace {

std::array<double, 3> sorted_extents(const TriangleMesh& mesh) {
  const BoundingBox box = bounding_box(mesh);
  std::array<double, 3> extents{box.high.x - box.low.x, box.high.y - box.low.y,
                                box.high.z - box.low.z};
  std::sort(extents.begin(), extents.end(), std::greater<>{});
  return extents;
}

double equivalent_diameter(const TriangleMesh& mesh) {
  return std::cbrt(6 / std::numbers::pi * solid_properties(mesh).volume);
}

struct Sample {
  double mean;
  double deviation;
};

Sample sample_of(const std::vector<double>& values) {
  double mean = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  double variance = 0;
  for (const double v : values) {
    variance += (v - mean) * (v - mean) / static_cast<double>(values.size() - 1);
  }
  return {mean, std::sqrt(variance)};
}

TEST(GrainGenerator, DependsOnlyOnItsArguments) {
  const GrainStatistics statistics;
  const TriangleMesh grain = generate_grain(statistics, 7, 3);
  (void)generate_grain(statistics, 7, 4);
  const TriangleMesh again = generate_grain(statistics, 7, 3);
  EXPECT_EQ(grain.vertices, again.vertices);
  EXPECT_EQ(grain.triangles, again.triangles);
  EXPECT_NE(grain.vertices, generate_grain(statistics, 7, 4).vertices);
  EXPECT_NE(grain.vertices, generate_grain(statistics, 8, 3).vertices);
}

// All bits of three grains, so that a machine or compiler that computes otherwise is found out.
TEST(GrainGenerator, GivesTheseBits) {
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a over 64-bit words
  for (std::uint64_t index = 0; index < 3; ++index) {
    for (const Vec3& v : generate_grain({}, 1, index, 20).vertices) {
      for (int axis = 0; axis < 3; ++axis) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(v[axis])) * 0x100000001b3;
      }
    }
  }
  EXPECT_EQ(hash, 10340950097631471905U);
}

TEST(GrainGenerator, GrainsAreInTheirPrincipalFrame) {
  const SolidProperties solid = solid_properties(generate_grain({}, 1, 0));
  const double size = std::cbrt(solid.volume);
  EXPECT_LT(norm(solid.centroid), 1e-12 * size);
  const double scale = 1e-12 * solid.inertia.row_z.z;
  EXPECT_NEAR(solid.inertia.row_x.y, 0, scale);
  EXPECT_NEAR(solid.inertia.row_x.z, 0, scale);
  EXPECT_NEAR(solid.inertia.row_y.z, 0, scale);
  EXPECT_LE(solid.inertia.row_x.x, solid.inertia.row_y.y);
  EXPECT_LE(solid.inertia.row_y.y, solid.inertia.row_z.z);
}

TEST(GrainGenerator, FormAndSizeAreExact) {
  GrainStatistics statistics;
  statistics.median_diameter = 2e-3;
  statistics.log_deviation = 0;
  statistics.elongation = {0.6, 0};
  statistics.flatness = {0.7, 0};
  for (std::uint64_t index = 0; index < 5; ++index) {
    const TriangleMesh grain = generate_grain(statistics, 1, index, 20);
    const auto [length, width, thickness] = sorted_extents(grain);
    EXPECT_NEAR(width / length, 0.6, 1e-12);
    EXPECT_NEAR(thickness / width, 0.7, 1e-12);
    EXPECT_NEAR(equivalent_diameter(grain), 2e-3, 1e-15);
  }
}

TEST(GrainGenerator, PopulationHasItsStatistics) {
  GrainStatistics statistics;
  statistics.log_deviation = 0.3;
  statistics.highest_degree = 8;
  constexpr int count = 200;
  std::vector<double> log_diameter;
  std::vector<double> elongation;
  std::vector<double> flatness;
  for (std::uint64_t index = 0; index < count; ++index) {
    const TriangleMesh grain = generate_grain(statistics, 5, index, 8);
    const auto [length, width, thickness] = sorted_extents(grain);
    log_diameter.push_back(std::log(equivalent_diameter(grain) / statistics.median_diameter));
    elongation.push_back(width / length);
    flatness.push_back(thickness / width);
  }
  // Means within three standard errors, deviations (whose relative standard error is
  // 1 / sqrt(2 n) = 5 %) within fifteen per cent.
  const auto expect = [&](const std::vector<double>& values, double mean, double deviation) {
    const Sample found = sample_of(values);
    EXPECT_NEAR(found.mean, mean, 3 * deviation / std::sqrt(count));
    EXPECT_NEAR(found.deviation / deviation, 1, 0.15);
  };
  expect(log_diameter, 0, 0.3);
  expect(elongation, statistics.elongation.mean, statistics.elongation.deviation);
  expect(flatness, statistics.flatness.mean, statistics.flatness.deviation);
}

TEST(GrainGenerator, SizesStayInsideTheirLimits) {
  GrainStatistics statistics;
  statistics.log_deviation = 0.8;
  statistics.smallest_diameter = 0.8e-3;
  statistics.largest_diameter = 1.1e-3;
  statistics.highest_degree = 4;
  for (std::uint64_t index = 0; index < 30; ++index) {
    const double diameter = equivalent_diameter(generate_grain(statistics, 5, index, 4));
    EXPECT_GE(diameter, 0.8e-3 * (1 - 1e-12));
    EXPECT_LE(diameter, 1.1e-3 * (1 + 1e-12));
  }
}

/// The radius of the largest ball inside the mesh, searched on ever finer grids.
double largest_inner_ball(const TriangleBvh& bvh, double reach) {
  Vec3 best;
  double depth = -bvh.signed_distance(best);
  for (double step = reach / 4; step > 1e-3 * reach; step *= 0.6) {
    const Vec3 center = best;
    for (int n = 0; n < 125; ++n) {
      const Vec3 at =
          center + step * Vec3{n % 5 - 2.0, n / 5 % 5 - 2.0, std::floor(n / 25.0) - 2.0};
      if (-bvh.signed_distance(at) > depth) {
        depth = -bvh.signed_distance(at);
        best = at;
      }
    }
  }
  return depth;
}

// A ball of the corner radius rolls along the whole inside of the surface; a larger one does not
// fit into the corners. Without roughness that is the definition of Wadell's roundness.
TEST(GrainGenerator, CornersHaveTheirRoundness) {
  for (const double roundness : {0.3, 0.6}) {
    GrainStatistics statistics;
    statistics.roughness = 0;
    statistics.highest_degree = 4;
    statistics.roundness = {roundness, 0};
    for (std::uint64_t index = 0; index < 2; ++index) {
      const TriangleMesh grain = generate_grain(statistics, 9, index, 24);
      const TriangleBvh bvh{grain};
      const double radius = roundness * largest_inner_ball(bvh, 0.3 * statistics.median_diameter);
      const auto part_that_fits = [&](double ball) {
        std::size_t fitting = 0;
        for (const TriangleMesh::Triangle& t : grain.triangles) {
          const Vec3& a = grain.vertices[t[0]];
          const Vec3& b = grain.vertices[t[1]];
          const Vec3& c = grain.vertices[t[2]];
          const Vec3 inside = (a + b + c) / 3 - ball * normalized(cross(b - a, c - a));
          fitting += bvh.signed_distance(inside) < -0.97 * ball ? 1U : 0U;
        }
        return static_cast<double>(fitting) / static_cast<double>(grain.triangles.size());
      };
      EXPECT_GT(part_that_fits(0.9 * radius), 0.99);
      EXPECT_LT(part_that_fits(1.2 * radius), 0.9);
    }
  }
}

/// Variance of ln(radius) at each degree, over the directions of the mesh.
std::vector<double> degree_variances(const TriangleMesh& grain, std::uint32_t degree) {
  std::vector<double> weight(grain.vertices.size());
  for (const TriangleMesh::Triangle& t : grain.triangles) {
    const Vec3 a = normalized(grain.vertices[t[0]]);
    const Vec3 b = normalized(grain.vertices[t[1]]);
    const Vec3 c = normalized(grain.vertices[t[2]]);
    const double third = norm(cross(b - a, c - a)) / 6;
    for (const std::uint32_t v : t) weight[v] += third;
  }
  // Without the mean, whose quadrature error would show as variance.
  const double typical = 0.5 * equivalent_diameter(grain);
  const SphericalHarmonicBasis basis{degree};
  std::vector<std::complex<double>> unit(SphericalHarmonicBasis::count(degree));
  std::vector<double> variances(degree + 1);
  for (std::uint32_t n = 0; n <= degree; ++n) {
    for (std::uint32_t m = 0; m <= n; ++m) {
      for (const std::complex<double> part : {std::complex<double>{1, 0}, {0, -1}}) {
        if (m == 0 && part.imag() != 0) continue;
        // Real harmonics of unit norm: P_n0, and sqrt(2) P_nm cos(m phi), sqrt(2) P_nm sin(m phi).
        unit[SphericalHarmonicBasis::index(n, m)] = m == 0 ? part : part / std::numbers::sqrt2;
        double projection = 0;
        for (std::size_t v = 0; v < weight.size(); ++v) {
          projection += weight[v] * std::log(norm(grain.vertices[v]) / typical) *
                        basis.evaluate(unit, normalized(grain.vertices[v]));
        }
        variances[n] += projection * projection / (4 * std::numbers::pi);
        unit[SphericalHarmonicBasis::index(n, m)] = 0;
      }
    }
  }
  return variances;
}

// On nearly spherical bodies the roughness stands alone. Degrees 1 and 2 are changed by centring
// and by making the form exact.
TEST(GrainGenerator, RoughnessHasItsAmplitudeAndSpectrum) {
  GrainStatistics statistics;
  statistics.elongation = {1, 0};
  statistics.flatness = {1, 0};
  statistics.roundness = {0.95, 0};
  statistics.fewest_faces = statistics.most_faces = 100;
  statistics.face_irregularity = 0;
  statistics.roughness = 0.04;
  statistics.hurst = 0.5;
  statistics.lowest_degree = 4;
  statistics.highest_degree = 8;
  constexpr int count = 30;
  std::vector<double> mean(9);
  for (std::uint64_t index = 0; index < count; ++index) {
    const std::vector<double> one = degree_variances(generate_grain(statistics, 3, index, 12), 8);
    for (std::size_t n = 0; n < mean.size(); ++n) mean[n] += one[n] / count;
  }
  double weights = 0;
  for (int n = 4; n <= 8; ++n) weights += std::pow(n, -2.0);
  double total = 0;
  for (std::uint32_t n = 4; n <= 8; ++n) {
    // The grains give count * (2n + 1) squares; their mean has a relative error of sqrt(2 / that).
    const double expected = 0.04 * 0.04 * std::pow(n, -2.0) / weights;
    EXPECT_NEAR(mean[n] / expected, 1, 3.5 * std::sqrt(2.0 / (count * (2 * n + 1))))
        << "degree " << n;
    total += mean[n];
  }
  EXPECT_NEAR(std::sqrt(total), 0.04, 0.002);
  EXPECT_LT(mean[3], 0.1 * mean[4]);
}

TEST(GrainGenerator, ExtremesAreStillClosedSurfaces) {
  GrainStatistics sharp;
  sharp.roundness = {0, 0};
  sharp.fewest_faces = sharp.most_faces = 6;
  sharp.face_irregularity = 0.5;
  GrainStatistics pebble;
  pebble.roundness = {0.95, 0};
  pebble.elongation = {0.3, 0};
  pebble.flatness = {0.3, 0};
  GrainStatistics rough;
  rough.roughness = 0.2;
  rough.hurst = 0;
  rough.lowest_degree = 2;
  GrainStatistics varied;
  varied.elongation = {0.7, 0.15};
  varied.flatness = {0.7, 0.15};
  varied.roundness = {0.4, 0.25};
  for (const GrainStatistics& statistics : {GrainStatistics{}, sharp, pebble, rough, varied}) {
    for (std::uint64_t index = 0; index < 6; ++index) {
      EXPECT_NO_THROW(require_closed_surface(generate_grain(statistics, 2, index, 20), "grain"));
    }
  }
}

TEST(GrainGenerator, BadStatisticsAreNamed) {
  const auto expect_bad = [](auto&& change, const char* field) {
    GrainStatistics statistics;
    change(statistics);
    test::expect_error([&] { statistics.validate(); }, {"grain statistics", field});
    test::expect_error([&] { (void)generate_grain(statistics, 1, 0); }, {field});
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_bad([](auto& s) { s.median_diameter = 0; }, "median_diameter is 0");
  expect_bad([&](auto& s) { s.median_diameter = nan; }, "median_diameter is nan");
  expect_bad([](auto& s) { s.log_deviation = -1; }, "log_deviation is -1");
  expect_bad([](auto& s) { s.smallest_diameter = 1; }, "smallest_diameter is 1");
  expect_bad([](auto& s) { s.largest_diameter = 1e-9; }, "largest_diameter is 1e-09");
  expect_bad([](auto& s) { s.elongation.mean = 0.2; }, "elongation.mean is 0.2");
  expect_bad([](auto& s) { s.elongation = {0.95, 0.3}; }, "elongation.deviation is 0.3");
  expect_bad([&](auto& s) { s.flatness.deviation = nan; }, "flatness.deviation is nan");
  expect_bad([](auto& s) { s.roundness.mean = 1; }, "roundness.mean is 1");
  expect_bad([](auto& s) { s.fewest_faces = 5; }, "fewest_faces is 5");
  expect_bad([](auto& s) { s.most_faces = 9; }, "most_faces is 9");
  expect_bad([](auto& s) { s.face_irregularity = 0.9; }, "face_irregularity is 0.9");
  expect_bad([](auto& s) { s.roughness = 0.5; }, "roughness is 0.5");
  expect_bad([](auto& s) { s.hurst = 3; }, "hurst is 3");
  expect_bad([](auto& s) { s.lowest_degree = 1; }, "lowest_degree is 1");
  expect_bad([](auto& s) { s.highest_degree = 2; }, "highest_degree is 2");
  test::expect_error([] { (void)generate_grain({}, 1, 0, 10); }, {"mesh frequency is 10", "20"});
}

}  // namespace
}  // namespace reckon
