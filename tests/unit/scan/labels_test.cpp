// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/labels.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace reckon {
namespace {

/// One line of voxels along x.
LabelVolume line(const std::vector<std::uint32_t>& labels) {
  LabelVolume volume{{static_cast<std::int32_t>(labels.size()), 1, 1}, 1};
  volume.values = labels;
  return volume;
}
GrayVolume depths(const std::vector<float>& values) {
  GrayVolume volume{{static_cast<std::int32_t>(values.size()), 1, 1}, 1};
  volume.values = values;
  return volume;
}

/// Joins the pieces of a whole volume; returns how many were joined to others.
std::uint32_t join(LabelVolume& labels, const GrayVolume& depth, const NeckRules& rules,
                   const GrayVolume* gray = nullptr) {
  NeckJoiner joiner;
  joiner.add(labels, depth, gray, labels.dims[2]);
  const JoinedPieces joined = joiner.join(rules);
  for (std::uint32_t& label : labels.values) label = joined.label[label];
  return joined.joined;
}

TEST(Labels, WideNecksAreJoinedAndNarrowOnesNot) {
  const GrayVolume depth = depths({1, 10, 9.5F, 9.4F, 10, 3, 2.9F, 8, 1});
  LabelVolume labels = line({1, 1, 1, 2, 2, 2, 3, 3, 3});
  EXPECT_EQ(join(labels, depth, {.wide = 0.9}), 1U);
  EXPECT_EQ(labels.values, (std::vector<std::uint32_t>{1, 1, 1, 1, 1, 1, 3, 3, 3}));
  LabelVolume strict = line({1, 1, 1, 2, 2, 2, 3, 3, 3});
  EXPECT_EQ(join(strict, depth, {.wide = 0.95}), 0U);
}

TEST(Labels, NarrowNecksAreJoinedWhereTheGrayIsThatOfSolid) {
  // A neck of eight tenths between two pieces, one of which is darker than the other.
  const std::array<std::int32_t, 3> dims{40, 4, 1};
  GrayVolume depth{dims, 1, 10};
  GrayVolume gray{dims, 1, 190};
  LabelVolume pieces{dims, 1, 1};
  for (std::int32_t j = 0; j < 4; ++j) {
    for (std::int32_t i = 20; i < 40; ++i) {
      pieces.values[pieces.index(i, j, 0)] = 2;
      gray.values[gray.index(i, j, 0)] = 180;
    }
    for (const std::int32_t i : {19, 20}) depth.values[depth.index(i, j, 0)] = 8;
  }
  const auto joined = [&](float gray_of_neck) {
    for (std::int32_t j = 0; j < 4; ++j) {
      for (const std::int32_t i : {19, 20}) gray.values[gray.index(i, j, 0)] = gray_of_neck;
    }
    LabelVolume labels = pieces;
    return join(labels, depth, {.void_gray = 100, .solid_gray = 200}, &gray);
  };
  EXPECT_EQ(joined(184), 1U);
  EXPECT_EQ(joined(180), 0U);  // about 5 % of the step of 85 are missing
  LabelVolume labels = pieces;
  EXPECT_EQ(join(labels, depth, {}), 0U);
}

TEST(Labels, NumbersFollowTheFirstVoxels) {
  LabelVolume labels = line({0, 7, 7, 3, 0, 9, 7});
  Renumbering numbering;
  numbering.apply(labels);
  EXPECT_EQ(numbering.count(), 3U);
  EXPECT_EQ(labels.values, (std::vector<std::uint32_t>{0, 1, 1, 2, 0, 3, 1}));
}

TEST(Labels, GrainsAreCountedByWhyTheyAreDropped) {
  LabelVolume labels{{9, 5, 5}, 1};
  const auto fill = [&](std::int32_t low, std::int32_t high, std::uint32_t label) {
    for (std::int32_t k = 1; k < 4; ++k) {
      for (std::int32_t j = 1; j < 4; ++j) {
        for (std::int32_t i = low; i <= high; ++i) labels.values[labels.index(i, j, k)] = label;
      }
    }
  };
  fill(0, 1, 1);
  fill(3, 4, 2);
  fill(6, 6, 3);
  const Workspace work{std::filesystem::temp_directory_path(), 0, 0};
  const auto grains = measure_labels(on_disk(labels, work.folder), work);
  ASSERT_EQ(grains.size(), 3U);
  EXPECT_EQ(grains[1].voxels, 18U);
  EXPECT_EQ(grains[1].low, (std::array<std::int32_t, 3>{3, 1, 1}));
  EXPECT_EQ(grains[1].high, (std::array<std::int32_t, 3>{4, 3, 3}));
  const GrainChoice choice = choose_grains(grains, false, 10);
  EXPECT_EQ(choice.kept, std::vector<std::uint32_t>{2});
  EXPECT_EQ(choice.on_border, 1U);
  EXPECT_EQ(choice.tiny, 1U);
  EXPECT_EQ(choose_grains(grains, true, 10).kept, (std::vector<std::uint32_t>{1, 2}));
}

TEST(Labels, GrowLayerByLayerAndTheLowerNumberWinsTies) {
  EXPECT_EQ(grown(line({2, 0, 0, 0, 0, 0, 1}), 2).values,
            (std::vector<std::uint32_t>{2, 2, 2, 0, 1, 1, 1}));
  EXPECT_EQ(grown(line({2, 0, 0, 0, 1}), 2).values, (std::vector<std::uint32_t>{2, 2, 1, 1, 1}));
}

}  // namespace
}  // namespace reckon
