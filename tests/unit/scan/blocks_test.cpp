// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "../avatar/expect_error.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/scan/disk_volume.hpp"
#include "reckon/scan/image_filters.hpp"
#include "scan_fixture.hpp"

namespace reckon {
namespace {

using test::expect_error;

Workspace within(std::uint64_t block_voxels, std::int32_t overlap = 0) {
  return {std::filesystem::temp_directory_path(), 40 * block_voxels, overlap};
}

TEST(Blocks, EachVoxelLiesInOneCoreAndNoBlockIsTooLarge) {
  const VoxelDims dims{31, 17, 44};
  for (const std::uint64_t most : {100000U, 12000U, 5000U, 1500U}) {
    const Workspace work = within(most);
    Volume<int> seen{dims, 1};
    const auto blocks = work.blocks(dims, 4);
    EXPECT_EQ(blocks.size() == 1, most > seen.values.size());
    for (const Block& block : blocks) {
      EXPECT_LE(block.whole.voxels(), most);
      EXPECT_EQ(block.whole, block.core.widened(4, Box{dims}));
      for_each_voxel(block.core, [&](auto... at) { ++seen.values[seen.index(at...)]; });
    }
    std::int32_t layers = 0;
    for (const Box& slab : work.slabs(dims)) {
      EXPECT_EQ(slab.low[2], layers);
      EXPECT_LE(slab.voxels(), most);
      layers += slab.dims[2];
    }
    EXPECT_EQ(layers, dims[2]);
    EXPECT_TRUE(std::all_of(seen.values.begin(), seen.values.end(), [](int n) { return n == 1; }));
  }
  expect_error([&] { (void)within(500).blocks(dims, 4); }, {"--memory", "too small"});
}

TEST(DiskVolumes, GiveBackTheBoxesThatWereWritten) {
  const Box all{{7, 5, 4}};
  Volume<std::uint32_t> numbers{all, 1};
  for (std::size_t v = 0; v < numbers.values.size(); ++v) {
    numbers.values[v] = static_cast<std::uint32_t>(v);
  }
  LabelsOnDisk stored{all.dims, 1, std::filesystem::temp_directory_path()};
  const Box part{{2, 1, 1}, {4, 3, 2}};
  const auto expect_part = [&](const Box& box, const Box& written) {
    const LabelVolume read = stored.read(box);
    EXPECT_EQ(read.low, box.low);
    for_each_voxel(box, [&](auto... at) {
      EXPECT_EQ(read.values[read.index(at...)],
                written.holds(at...) ? numbers.values[numbers.index(at...)] : 0U);
    });
  };
  stored.write(numbers, part);
  expect_part(all, part);
  const Box layers{{0, 0, 1}, {7, 5, 3}};
  stored.write(numbers, layers);
  expect_part(all, layers);
  expect_part({{1, 0, 2}, {5, 5, 2}}, layers);
  // From a part that lies elsewhere in memory.
  stored.write(numbers, all);
  const LabelVolume piece = stored.read(part);
  stored = LabelsOnDisk{all.dims, 1, std::filesystem::temp_directory_path()};
  stored.write(piece, part);
  expect_part(all, part);
}

class BlockedScans : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_ct_component()) GTEST_SKIP() << "built without the component ct";
  }

  testing::TestAssembly assembly_ = testing::bumpy_assembly(6, 1, 4);
  SimulatedScan scan_ = [&] {
    ScannerSettings settings;
    settings.voxel = 95e-6;
    return scan_assembly(assembly_.grains, assembly_.reader(), settings);
  }();
};

TEST_F(BlockedScans, GiveTheSameBitsAsTheWhole) {
  const auto whole = testing::run_chain(assembly_, scan_);
  const auto parts = testing::run_chain(assembly_, scan_, within(52000, 14));
  EXPECT_EQ(whole.blocks.blocks, 1U);
  EXPECT_GT(parts.blocks.blocks, 3U);
  EXPECT_EQ(parts.blocks.disputed, 0U);
  EXPECT_GT(whole.figures.found_once, 8U);
  EXPECT_EQ(whole.figures.found_once, parts.figures.found_once);
  EXPECT_TRUE(whole.labels.values == parts.labels.values);
  ASSERT_EQ(whole.assembly.shapes.size(), parts.assembly.shapes.size());
  for (std::size_t n = 0; n < whole.assembly.shapes.size(); ++n) {
    EXPECT_EQ(shape_digest(whole.assembly.shapes[n].whole()),
              shape_digest(parts.assembly.shapes[n].whole()));
    EXPECT_EQ(whole.assembly.grains[n], parts.assembly.grains[n]);
  }
  ASSERT_EQ(whole.assembly.contacts.size(), parts.assembly.contacts.size());
  EXPECT_GT(whole.assembly.contacts.size(), 5U);
  for (std::size_t c = 0; c < whole.assembly.contacts.size(); ++c) {
    EXPECT_EQ(whole.assembly.contacts[c].gray_gap, parts.assembly.contacts[c].gray_gap);
  }
}

TEST_F(BlockedScans, FilledOpenedAndMedianMasksAreThoseOfTheWhole) {
  const auto mask_within = [&](const Workspace& work) {
    GrayVolume hollow = scan_.gray;
    const auto& dims = hollow.dims;
    for (std::int32_t k = 2; k < dims[2]; k += 5) {
      for (std::int32_t j = 2; j < dims[1]; j += 5) {
        for (std::int32_t i = 2; i < dims[0]; i += 5) hollow.values[hollow.index(i, j, k)] = 1e4F;
      }
    }
    MaskSettings settings;
    settings.open_radius = 1;
    const GrayOnDisk quiet =
        denoised(on_disk(hollow, work.folder), {Denoising::median, 0, 0}, work);
    const MaskOnDisk mask = find_solid(quiet, settings, work).mask;
    return mask.read(mask.box()).values;
  };
  EXPECT_TRUE(mask_within(within(1U << 20U)) == mask_within(within(60000, 10)));
}

TEST_F(BlockedScans, RefuseGrainsThatAreLargerThanTheOverlap) {
  expect_error([&] { (void)testing::run_chain(assembly_, scan_, within(52000, 2)); },
               {"too large for the blocks", "--memory", "--overlap"});
}

}  // namespace
}  // namespace reckon
