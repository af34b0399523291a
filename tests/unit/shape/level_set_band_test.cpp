// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/shape/level_set_band.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "reckon/core/random.hpp"
#include "support/band_shape.hpp"
#include "support/test_shapes.hpp"

namespace reckon {
namespace {

LevelSet decoded(const LevelSet& grid) {
  LevelSet copy = grid;
  decode_band(encode_band(grid), copy);
  return copy;
}

std::vector<Shape> forms() {
  return {testing::sphere(1.0, 50, 60), testing::box({1.2, 1.2, 0.15}, 9, 0.06),
          testing::bumpy_grain(1e-4, 90, 12), testing::bumpy_grain(400, 100, 40)};
}

/// Distances that no shape has: every vertex a world of its own.
LevelSet noise(std::uint64_t seed) {
  RandomStream random{seed, RandomPurpose::other, 5};
  LevelSet grid{{9, 6, 11}, 0.25, {}, {}};
  for (int v = 0; v < 9 * 6 * 11; ++v) {
    grid.values.push_back(static_cast<float>(random.uniform(-1, 1)));
  }
  return grid;
}

TEST(LevelSetBand, HoldsTheFullGridNearTheSurface) {
  for (const Shape& shape : forms()) {
    const LevelSet& full = shape.level_set;
    const LevelSet band = decoded(full);
    const double width = band_half_width * full.spacing;
    const double half_count = width / LevelSetBand::half_counts / 2 * (1 + 1e-3);
    double deepest_error = 0;
    for (std::size_t v = 0; v < full.values.size(); ++v) {
      const double phi = full.values[v];
      if (phi >= width) {
        ASSERT_NEAR(band.values[v], width, 1e-6 * width);
      } else if (phi > -width) {
        ASSERT_NEAR(band.values[v], phi, half_count);
      } else {
        ASSERT_LE(band.values[v], -width * (1 - 1e-6));
        deepest_error = std::max(deepest_error, std::abs(band.values[v] - phi));
      }
    }
    // Between the points of a lattice of every 4th vertex, where the slope is 1 or so.
    EXPECT_LT(deepest_error, 5 * full.spacing);
  }
}

TEST(LevelSetBand, WhatIsDecodedEncodesToTheSameWords) {
  for (const Shape& shape : forms()) {
    const auto words = encode_band(shape.level_set);
    EXPECT_EQ(encode_band(decoded(shape.level_set)), words);
    EXPECT_TRUE(is_band(shape.level_set.dims, words));
  }
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const LevelSet grid = noise(seed);
    const auto words = encode_band(grid);
    EXPECT_EQ(encode_band(decoded(grid)), words);
    EXPECT_TRUE(is_band(grid.dims, words));
  }
}

TEST(LevelSetBand, EveryCellReadsAsThatOfTheDecodedGrid) {
  std::vector<LevelSet> grids{noise(3), noise(4)};
  for (const Shape& shape : forms()) grids.push_back(shape.level_set);
  for (const LevelSet& grid : grids) {
    const LevelSet whole = decoded(grid);
    const auto words = encode_band(grid);
    const LevelSetBand band{grid.dims, grid.spacing, words};
    const LevelSetView view{whole};
    for (std::int32_t k = 0; k + 1 < grid.dims[2]; ++k) {
      for (std::int32_t j = 0; j + 1 < grid.dims[1]; ++j) {
        for (std::int32_t i = 0; i + 1 < grid.dims[0]; ++i) {
          const auto expected = view.corners(i, j, k);
          const auto found = band.corners(i, j, k);
          for (std::size_t c = 0; c < 8; ++c) ASSERT_EQ(double{found[c]}, expected[c]);
        }
      }
    }
  }
}

/// The memory of 20,000 grains of 60 voxels and 5,000 nodes.
TEST(LevelSetBand, AGrainOfSixtyVoxelsTakesAQuarterOfAMegabyte) {
  Shape shape = testing::bumpy_grain(1e-3, 5000, 66);  // 60 along its equal sphere
  const std::uint64_t full = outline_of(shape).memory();
  round_to_band(shape);
  const std::uint64_t band = outline_of(shape).memory();
  EXPECT_LT(band, 280'000U);
  EXPECT_GT(full, 4 * band);
}

TEST(LevelSetBand, RoundedShapesKeepTheirBounds) {
  for (const Shape& shape : forms()) {
    const testing::BandShape band{shape};
    const Shape& whole = band.whole();
    EXPECT_EQ(whole.lipschitz, lipschitz_constant(whole.level_set));
    EXPECT_NEAR(whole.lipschitz, shape.lipschitz, 1e-3);
    for (std::size_t n = 0; n < whole.nodes.size(); ++n) {
      ASSERT_LE(norm(whole.nodes.position(n)), whole.bounding_radius);
      ASSERT_NEAR(norm(whole.nodes.position(n) - shape.nodes.position(n)), 0,
                  1e-7 * whole.bounding_radius);
    }
  }
}

TEST(KeptShape, GivesBackWhatItWasGiven) {
  for (const Shape& shape : forms()) {
    const testing::BandShape band{shape};
    for (const Shape& given : {shape, band.whole()}) {
      const KeptShape kept{given};
      const Shape whole = kept.whole();
      EXPECT_EQ(whole.level_set.values, given.level_set.values);
      EXPECT_EQ(whole.nodes.x, given.nodes.x);
      EXPECT_EQ(whole.nodes.area, given.nodes.area);
      EXPECT_EQ(whole.clusters.size(), given.clusters.size());
      EXPECT_EQ(kept.view().nodes.position(3), given.nodes.position(3));
      EXPECT_EQ(kept.view().clusters.size(), given.clusters.size());
    }
    EXPECT_TRUE(band.kept().entry().level_set.values.empty());
    EXPECT_EQ(band.kept().entry().nodes.size(), 0U);
  }
}

/// Words from outside that lead beyond themselves are told from those that do not.
TEST(LevelSetBand, FaultyWordsAreFound) {
  const LevelSet grid = testing::bumpy_grain(1.0, 50, 12).level_set;
  const auto words = encode_band(grid);
  RandomStream random{1, RandomPurpose::other, 6};
  const auto any = [&](std::size_t below) {
    return static_cast<std::size_t>(random.uniform(0, static_cast<double>(below)));
  };
  int found = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    auto faulty = words;
    if (trial % 3 == 0) {
      faulty.resize(any(words.size()));
    } else {
      // Mostly in the tables; a changed count is another grain's, not a fault.
      faulty[any(trial % 3 == 1 ? words.size() / 4 : words.size())] ^=
          static_cast<LevelSetBand::Word>(1U << any(16));
    }
    if (!is_band(grid.dims, faulty)) {
      ++found;
      continue;
    }
    LevelSet harmless{grid.dims, grid.spacing, {}, {}};
    decode_band(faulty, harmless);  // the sanitizers see a step beyond the words
  }
  EXPECT_GT(found, 1500);
}

}  // namespace
}  // namespace reckon
