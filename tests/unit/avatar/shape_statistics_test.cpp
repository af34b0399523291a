// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/shape_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "expect_error.hpp"
#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/shape_sources.hpp"
#include "reckon/avatar/sieve_size.hpp"

namespace reckon {
namespace {

TEST(ShapeStatistics, SpreadOfKnownNumbers) {
  std::vector<double> values(11);
  std::iota(values.rbegin(), values.rend(), 0.0);
  const MeasureSpread spread = spread_of(values);
  EXPECT_EQ(spread.mean, 5);
  EXPECT_NEAR(spread.deviation, std::sqrt(11.0), 1e-12);
  EXPECT_EQ(spread.low, 0);
  EXPECT_EQ(spread.tenth, 1);
  EXPECT_EQ(spread.median, 5);
  EXPECT_EQ(spread.ninetieth, 9);
  EXPECT_EQ(spread.high, 10);
  EXPECT_EQ(spread_of(std::vector<double>{1, 2}).median, 1.5);
}

// Closed forms of the least square hole. A rectangle W x T fits upright into a square of W, turned
// by 45 degrees into one of (W + T) / sqrt 2; an ellipse turned into one of sqrt((W^2 + T^2) / 2).
TEST(ShapeStatistics, SieveSizeIsTheLeastSquareHole) {
  const auto size = [](TriangleMesh mesh) {
    return sieve_size(to_principal_frame(std::move(mesh)).vertices);
  };
  const auto box = [&](double a, double b, double c) {
    return size(box_mesh({a / 2, b / 2, c / 2}, 10));
  };
  EXPECT_NEAR(box(4, 2, 1), 2, 1e-9);
  EXPECT_NEAR(box(1, 4, 2), 2, 1e-9) << "in any order";
  EXPECT_NEAR(box(4, 2, 0.5), 2.5 / std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(box(1, 1, 1), 1, 1e-9);
  EXPECT_NEAR(size(sphere_mesh(1, 0.1)), 2, 0.01);
  EXPECT_NEAR(size(ellipsoid_mesh({3, 2, 1}, 0.1)), std::sqrt(2 * (4 + 1.0)), 0.02);
  EXPECT_NEAR(size(cylinder_mesh(1, 3, 0.2)), 2, 0.01);
  // A thin disc of radius 1 falls through on edge: its shadow is 2 x 0.1.
  EXPECT_NEAR(size(cylinder_mesh(1, 0.05, 0.1)), 2.1 / std::sqrt(2.0), 0.01);
  const Shape shape = build_shape(box_mesh({2, 1, 0.5}, 0.5), {.node_count = 50}, "box");
  EXPECT_NEAR(shape.descriptors.sieve_size, 2, 1e-9);
}

ShapeLibrary population(const GrainStatistics& statistics, std::uint64_t seed,
                        std::uint64_t count) {
  std::vector<ShapeSource> sources;
  for (std::uint64_t n = 0; n < count; ++n) {
    sources.push_back(generated_source(statistics, seed, n));
  }
  return build_library(sources, {.voxels_per_diameter = 14, .node_count = 40});
}

double mean_of(const ShapeLibrary& library, double (*of)(const Shape&)) {
  double sum = 0;
  for (const Shape& shape : library) sum += of(shape) / static_cast<double>(library.size());
  return sum;
}

TEST(ShapeStatistics, AMatchedPopulationIsLikeItsModel) {
  GrainStatistics model;
  model.median_diameter = 3e-3;
  model.elongation = {0.65, 0.05};
  model.flatness = {0.7, 0.05};
  model.roundness = {0.7, 0.05};
  model.roughness = 0.012;
  model.highest_degree = 10;
  const ShapeLibrary library = population(model, 3, 12);
  const GrainStatistics matched =
      match_statistics(library, 8, {.trial_grains = 12, .rounds = 3, .voxels_per_diameter = 14});
  const ShapeLibrary made = population(matched, 8, 12);
  const ShapeLibrary plain = population(statistics_like(library), 8, 12);
  const auto roundness = [](const Shape& s) { return s.descriptors.roundness; };
  const auto convexity = [](const Shape& s) { return s.descriptors.convexity; };
  const auto elongation = [](const Shape& s) { return s.descriptors.elongation; };
  const auto diameter = [](const Shape& s) { return s.descriptors.equivalent_diameter; };
  EXPECT_NEAR(mean_of(made, elongation), mean_of(library, elongation), 0.05);
  EXPECT_NEAR(mean_of(made, diameter) / mean_of(library, diameter), 1, 0.15);
  EXPECT_NEAR(mean_of(made, roundness), mean_of(library, roundness), 0.05);
  EXPECT_NEAR(mean_of(made, convexity), mean_of(library, convexity), 0.01);
  // Which the unmatched statistics are not.
  EXPECT_GT(std::abs(mean_of(plain, roundness) - mean_of(library, roundness)), 0.05);
}

TEST(ShapeStatistics, TwoGrainsTellNone) {
  const Shape ball = build_shape(sphere_mesh(1, 0.2), {.node_count = 50}, "ball");
  test::expect_error([&] { (void)statistics_like({ball, ball}); }, {"2 grains", "3"});
}

}  // namespace
}  // namespace reckon
