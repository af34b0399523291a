// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <string>

#include "equal_morphologies.hpp"
#include "reckon/avatar/grid_mass.hpp"
#include "reckon/avatar/legacy_morphology.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/core/file.hpp"
#include "support/legacy_data.hpp"

namespace reckon {
namespace {

using LegacyData = testing::LegacyDataTest;

TEST_F(LegacyData, AllMorphologiesRoundTripAndAgreeWithTheirGrids) {
  const ShapeLibrary library = load_library(morphologies_);
  ASSERT_EQ(library.size(), 74U);
  EXPECT_EQ(library[0].name, "morph_1");
  EXPECT_EQ(library[9].name, "morph_10");
  for (std::size_t s = 0; s < library.size(); ++s) {
    const std::string name = "morph_" + std::to_string(s + 1) + ".dat";
    const LegacyMorphology read = parse_legacy_morphology(read_file(morphologies_ / name), name);
    test::expect_equal(to_legacy(library[s]), read);
    test::expect_equal(parse_legacy_morphology(format_legacy_morphology(read), name), read);
    const SolidProperties counted = grid_properties(library[s].level_set);
    EXPECT_NEAR(counted.volume / library[s].mass.volume, 1, 0.005) << name;
    EXPECT_NEAR(norm(counted.centroid), 0, 0.03) << name;
    double area = 0;
    for (const double a : library[s].nodes.area) area += a;
    EXPECT_NEAR(area / counted.surface_area, 1, 0.03) << name;
  }
}

TEST_F(LegacyData, PlacementsHaveOneLinePerGrain) {
  EXPECT_EQ(parse_legacy_positions(read_file(data_ / "positions_s592.dat"), "p").size(), 592U);
  EXPECT_EQ(parse_legacy_rotations(read_file(data_ / "rotations_s592.dat"), "r").size(), 592U);
}

}  // namespace
}  // namespace reckon
