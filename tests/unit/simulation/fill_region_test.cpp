// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/fill_region.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "reckon/core/error.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

/// How many grains a cylinder takes, as the refusal of too many says, or all that were asked for.
std::size_t most_in_cylinder(double radius, double height, std::uint32_t count) {
  ShapeLibrary shapes{testing::sphere(1.0, 20, 8)};
  FillPlacement fill;
  fill.count = count;
  fill.region = CylinderConfig{{0, 0, 0}, {0, 0, 1}, radius};
  fill.region_low = 0;
  fill.region_high = height;
  try {
    return fill_region(fill, testing::views_of(shapes), ShapeId{0}, GrainId{0}, 1).size();
  } catch (const Error& error) {
    const std::string& problem = error.text().problem;
    return std::strtoul(problem.c_str() + problem.find("only ") + 5, nullptr, 10);
  }
}

TEST(FillOfACylinder, AWiderOneNeverTakesFewer) {
  std::size_t before = 0;
  for (double radius = 0.5; radius < 12; radius += 0.037) {
    const std::size_t most = most_in_cylinder(radius, 7, 1'000'000);
    EXPECT_GE(most, before) << radius;
    // A square grid of cells 2.2 wide, three layers: what it takes at least and at most.
    EXPECT_LE(static_cast<double>(most), 3 * 3.1416 * radius * radius / (2.2 * 2.2) + 1) << radius;
    before = most;
    if (most == 0) continue;
    const auto all = static_cast<std::uint32_t>(most);
    EXPECT_EQ(most_in_cylinder(radius, 7, all), most) << radius;
  }
  EXPECT_EQ(most_in_cylinder(1.2, 7, 100), 3U);       // one in a layer
  EXPECT_EQ(most_in_cylinder(2.3, 7, 100), 6U);       // two, though four cells fit a square
  EXPECT_EQ(most_in_cylinder(2.7, 7, 100), 12U);      // four
  EXPECT_EQ(most_in_cylinder(2.7, 1e30, 100), 100U);  // however high
  EXPECT_EQ(most_in_cylinder(1.0, 1e30, 100), 0U);
}

}  // namespace
}  // namespace reckon
