// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/label_pieces.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "reckon/core/random.hpp"
#include "reckon/scan/from_scan.hpp"
#include "reckon/scan/image_filters.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

const std::filesystem::path scratch = std::filesystem::temp_directory_path();

/// Numbers pieces by flooding, the plain way.
std::vector<std::uint32_t> flooded(const LabelVolume& given) {
  std::vector<std::uint32_t> piece(given.values.size(), 0);
  std::uint32_t count = 0;
  for_each_voxel(given.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const std::size_t at = given.index(i, j, k);
    if (given.values[at] == 0 || piece[at] != 0) return;
    piece[at] = ++count;
    std::vector<VoxelDims> front{{i, j, k}};
    while (!front.empty()) {
      const VoxelDims here = front.back();
      front.pop_back();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int step : {-1, 1}) {
          VoxelDims next = here;
          next[axis] += step;
          if (!given.holds(next[0], next[1], next[2])) continue;
          const std::size_t to = given.index(next[0], next[1], next[2]);
          if (given.values[to] != given.values[at] || piece[to] != 0) continue;
          piece[to] = count;
          front.push_back(next);
        }
      }
    }
  });
  return piece;
}

TEST(LabelPieces, AreThoseOfAFloodWhateverTheMemory) {
  LabelVolume given{{17, 13, 19}, 1};
  for (std::size_t v = 0; v < given.values.size(); ++v) {
    RandomStream random{7, RandomPurpose::other, v / 2};
    given.values[v] = static_cast<std::uint32_t>(3 * random.uniform()) * 40;
  }
  const auto expected = flooded(given);
  for (const std::uint64_t voxels : {100000U, 700U, 1U}) {
    const Workspace work{scratch, 40 * voxels, 0};
    const LabelPieces pieces = find_label_pieces(on_disk(given, scratch), work);
    EXPECT_TRUE(pieces.labels.read(given.box()).values == expected);
    for (std::size_t v = 0; v < expected.size(); ++v) {
      if (expected[v] == 0) continue;
      EXPECT_EQ(pieces.given[expected[v] - 1], given.values[v]);
    }
  }
}

/// Balls in a volume of labels.
LabelVolume balls(const std::vector<std::pair<Vec3, std::uint32_t>>& list) {
  LabelVolume labels{{40, 18, 18}, 1e-3};
  for_each_voxel(labels.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    for (const auto& [center, label] : list) {
      if (norm(Vec3{i + 0.5, j + 0.5, k + 0.5} - center) < 5) {
        labels.values[labels.index(i, j, k)] = label;
      }
    }
  });
  return labels;
}

Segmentation segment(const LabelVolume& labels) {
  const std::filesystem::path folder = testing::test_path();
  std::filesystem::create_directories(folder);
  write_volume(folder / "labels.npy", to_gray(labels), VoxelType::uint16);
  SegmentSettings settings;
  settings.volume = {folder / "labels.npy", 1e-3, {}};
  settings.labelled = true;
  settings.fewest_voxels = 100;
  Segmentation scan = segment_scan(settings, folder, ScanStage::choose, {}, {});
  std::filesystem::remove_all(folder);
  return scan;
}

TEST(LabelPieces, APieceIsAGrainAndIsNamedByItsLabel) {
  if (!has_ct_component()) GTEST_SKIP() << "built without the component ct";
  LabelVolume labels = balls({{{8, 9, 9}, 7}, {{20, 9, 9}, 300}, {{32, 9, 9}, 7}});
  labels.values[labels.index(1, 1, 1)] = 300;  // a speck
  const Segmentation scan = segment(labels);
  EXPECT_EQ(scan.choice.kept.size(), 3U);
  EXPECT_EQ(scan.choice.tiny, 1U);
  std::map<std::string, std::uint64_t> sizes;
  for (const std::uint32_t label : scan.choice.kept) {
    const LabelledGrain& grain = scan.grains[label - 1];
    sizes[name_of(grain, label)] = grain.voxels;
  }
  EXPECT_EQ(sizes.size(), 3U);
  EXPECT_EQ(sizes["grain_7"], sizes["grain_7_2"]);
  EXPECT_TRUE(sizes.contains("grain_300"));
  ASSERT_EQ(scan.remarks.size(), 1U);
  EXPECT_NE(scan.remarks[0].find("label 7: 2 pieces of"), std::string::npos) << scan.remarks[0];
}

TEST(LabelPieces, AMaskIsNotTakenForLabelsInSilence) {
  if (!has_ct_component()) GTEST_SKIP() << "built without the component ct";
  const Segmentation scan = segment(balls({{{8, 9, 9}, 1}, {{30, 9, 9}, 1}}));
  EXPECT_EQ(scan.choice.kept.size(), 2U);
  ASSERT_EQ(scan.remarks.size(), 2U);
  EXPECT_NE(scan.remarks[1].find("one label only"), std::string::npos);
}

}  // namespace
}  // namespace reckon
