// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/segmentation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "../avatar/expect_error.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/scan/image_filters.hpp"
#include "scan_fixture.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

using test::expect_error;

class Segmentations : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_ct_component()) GTEST_SKIP() << "built without the component ct";
  }
};

const Workspace whole{std::filesystem::temp_directory_path(), 0, 0};

SolidMask find_solid(const GrayVolume& gray, const MaskSettings& settings) {
  return reckon::find_solid(on_disk(gray, whole.folder), settings, whole);
}
std::vector<std::uint8_t> solid_voxels(const GrayVolume& gray, const MaskSettings& settings) {
  const MaskOnDisk mask = find_solid(gray, settings).mask;
  return mask.read(mask.box()).values;
}
LabelVolume split_grains(const MaskVolume& mask) {
  const LabelsOnDisk labels =
      reckon::split_grains(on_disk(mask, whole.folder), {}, nullptr, {}, whole).labels;
  return labels.read(labels.box());
}
std::uint32_t count_of(const LabelVolume& labels) {
  return *std::max_element(labels.values.begin(), labels.values.end());
}
GrayVolume denoised(const GrayVolume& gray, const DenoiseSettings& settings) {
  const GrayOnDisk quiet = reckon::denoised(on_disk(gray, whole.folder), settings, whole);
  return quiet.read(quiet.box());
}

/// Balls of these centres and radii [voxels]; 1 inside.
MaskVolume balls(const std::vector<std::pair<Vec3, double>>& list, std::int32_t size) {
  MaskVolume mask{{size, size, size}, 1};
  for (std::int32_t k = 0; k < size; ++k) {
    for (std::int32_t j = 0; j < size; ++j) {
      for (std::int32_t i = 0; i < size; ++i) {
        for (const auto& [center, radius] : list) {
          if (norm(mask.center_world(i, j, k) - center) < radius) {
            mask.values[mask.index(i, j, k)] = 1;
          }
        }
      }
    }
  }
  return mask;
}

GrayVolume gray_of(const MaskVolume& mask, float low, float high) {
  GrayVolume gray{mask};
  for (std::size_t v = 0; v < mask.values.size(); ++v) {
    gray.values[v] = mask.values[v] != 0 ? high : low;
  }
  return gray;
}

TEST_F(Segmentations, ThresholdLiesHalfWayBetweenTheLevels) {
  const MaskVolume mask = balls({{{16, 16, 16}, 10}}, 32);
  const SolidMask found = find_solid(gray_of(mask, 50, 150), {});
  EXPECT_NEAR(found.levels.void_gray, 50, 1e-3);
  EXPECT_NEAR(found.levels.solid_gray, 150, 1e-3);
  EXPECT_NEAR(found.levels.threshold, 100, 1e-3);
  EXPECT_EQ(solid_voxels(gray_of(mask, 50, 150), {}), mask.values);
}

TEST_F(Segmentations, VoidsInsideGrainsAreFilled) {
  const MaskVolume ball = balls({{{16, 16, 16}, 10}}, 32);
  MaskVolume hollow = ball;
  hollow.values[hollow.index(16, 16, 16)] = 0;
  EXPECT_EQ(solid_voxels(gray_of(hollow, 0, 1), {}), ball.values);
  MaskSettings leave;
  leave.fill = false;
  EXPECT_EQ(solid_voxels(gray_of(hollow, 0, 1), leave), hollow.values);
}

TEST_F(Segmentations, OpeningRemovesSpecks) {
  MaskVolume mask = balls({{{16, 16, 16}, 10}}, 32);
  mask.values[mask.index(1, 1, 1)] = 1;
  const MaskVolume clean = opened(mask, 1);
  EXPECT_EQ(clean.values[mask.index(1, 1, 1)], 0);
  EXPECT_EQ(clean.values[mask.index(16, 16, 16)], 1);
}

TEST_F(Segmentations, DepthIsTheDistanceToTheNearestVoid) {
  const MaskVolume mask = balls({{{10, 9, 11}, 6}, {{15, 14, 10}, 4}}, 22);
  const GrayVolume depth = depth_in_solid(mask);
  const auto square = [](int d) { return d * d; };
  for (std::int32_t k = 0; k < 22; k += 3) {
    for (std::int32_t j = 0; j < 22; j += 2) {
      for (std::int32_t i = 0; i < 22; ++i) {
        int nearest = 22 * 22 * 3;
        for (std::int32_t c = 0; c < 22; ++c) {
          for (std::int32_t b = 0; b < 22; ++b) {
            for (std::int32_t a = 0; a < 22; ++a) {
              if (mask.values[mask.index(a, b, c)] != 0) continue;
              nearest = std::min(nearest, square(a - i) + square(b - j) + square(c - k));
            }
          }
        }
        EXPECT_NEAR(depth.values[depth.index(i, j, k)], std::sqrt(nearest), 1e-4);
      }
    }
  }
}

TEST_F(Segmentations, TouchingBallsAreSplitAtTheirNeck) {
  const MaskVolume mask = balls({{{14, 20, 20}, 9}, {{29, 20, 20}, 8}}, 42);
  const LabelVolume labels = split_grains(mask);
  EXPECT_EQ(count_of(labels), 2U);
  for (std::int32_t i = 0; i < 42; ++i) {
    const std::size_t v = mask.index(i, 20, 20);
    const std::uint32_t expected = mask.values[v] == 0 ? 0 : i < 22 ? 1 : 2;
    if (std::abs(i - 22) <= 1) continue;
    EXPECT_EQ(labels.values[v], expected) << i;
  }
  // A grain with a waist that is nearly as wide as itself stays whole.
  const MaskVolume peanut = balls({{{17, 20, 20}, 9}, {{21, 20, 20}, 9}}, 42);
  EXPECT_EQ(count_of(split_grains(peanut)), 1U);
}

TEST_F(Segmentations, DiffusionTakesNoiseAndKeepsTheEdge) {
  const auto assembly = testing::bumpy_assembly(1, 1, 1);
  ScannerSettings settings;
  settings.voxel = 50e-6;
  settings.noise = 0.1;
  const SimulatedScan noisy = scan_assembly(assembly.grains, assembly.reader(), settings);
  settings.noise = 0;
  const SimulatedScan clean = scan_assembly(assembly.grains, assembly.reader(), settings);
  const auto deviation = [&](const GrayVolume& gray) {
    double squares = 0;
    for (std::size_t v = 0; v < gray.values.size(); ++v) {
      const double d = gray.values[v] - clean.gray.values[v];
      squares += d * d;
    }
    return std::sqrt(squares / static_cast<double>(gray.values.size())) / 30000;
  };
  EXPECT_NEAR(deviation(noisy.gray), 0.1, 0.005);
  EXPECT_LT(deviation(denoised(noisy.gray, {})), 0.05);
  EXPECT_LT(deviation(denoised(noisy.gray, {Denoising::median, 0, 0})), 0.05);
}

TEST_F(Segmentations, FaultsSayWhatToDo) {
  GrayVolume flat{{8, 8, 8}, 1, 3};
  expect_error([&] { (void)find_solid(flat, {}); }, {"one gray value"});
  const GrayVolume gray = gray_of(balls({{{16, 16, 16}, 10}}, 32), 0, 1);
  MaskSettings high;
  high.threshold = 5;
  expect_error([&] { (void)find_solid(gray, high); }, {"no grains", "--threshold"});
  MaskSettings low;
  low.threshold = -5;
  expect_error([&] { (void)find_solid(gray, low); }, {"no void"});
  MaskVolume block{{24, 24, 24}, 1, 1};
  block.values[5] = 0;
  expect_error([&] { (void)split_grains(block); }, {"one blob", "--neck"});
}

TEST_F(Segmentations, StagesAreTakenUpAgainAndMadeAnewWhenSettingsChange) {
  const std::filesystem::path folder = testing::test_path();
  std::filesystem::create_directories(folder);
  const auto assembly = testing::bumpy_assembly(2, 1, 1);
  ScannerSettings scanner;
  scanner.voxel = 50e-6;
  write_volume(folder / "scan.npy", scan_assembly(assembly.grains, assembly.reader(), scanner).gray,
               VoxelType::uint16);
  SegmentSettings settings;
  settings.volume = {folder / "scan.npy", 50e-6, {}};
  const auto run = [&] { return segment_scan(settings, folder, ScanStage::choose, {}, {}); };
  const Segmentation first = run();
  EXPECT_TRUE(first.resumed.empty());
  EXPECT_EQ(first.choice.kept.size(), 2U);
  const Segmentation again = run();
  EXPECT_EQ(again.resumed.size(), 3U);
  const auto values = [](const auto& volume) { return volume.read(volume.box()).values; };
  EXPECT_EQ(values(again.labels), values(first.labels));
  EXPECT_EQ(values(again.mask), values(first.mask));
  EXPECT_EQ(values(again.denoised), values(first.denoised));
  EXPECT_EQ(again.levels.threshold, first.levels.threshold);
  settings.split.neck = 0.8;
  EXPECT_EQ(run().resumed, (std::vector{ScanStage::denoise, ScanStage::threshold}));
  std::filesystem::resize_file(folder / "stage-denoise.h5", 700);
  EXPECT_EQ(run().resumed, (std::vector{ScanStage::threshold, ScanStage::split}));
  settings.fewest_voxels = 1000000;
  expect_error([&] { (void)run(); }, {"no grains", "fewer than 1000000 voxels"});
  std::filesystem::remove_all(folder);
}

TEST_F(Segmentations, AnyNumberOfThreadsGivesTheSameBits) {
  const auto assembly = testing::bumpy_assembly(2, 2, 1);
  ScannerSettings scanner;
  scanner.voxel = 60e-6;
  const SimulatedScan scan = scan_assembly(assembly.grains, assembly.reader(), scanner);
  const int threads = thread_count();
  set_thread_count(1);
  const auto one = testing::run_chain(assembly, scan);
  set_thread_count(3);
  const auto three = testing::run_chain(assembly, scan);
  set_thread_count(threads);
  EXPECT_TRUE(one.labels.values == three.labels.values);
  ASSERT_EQ(one.assembly.shapes.size(), three.assembly.shapes.size());
  for (std::size_t n = 0; n < one.assembly.shapes.size(); ++n) {
    EXPECT_EQ(shape_digest(one.assembly.shapes[n].whole()),
              shape_digest(three.assembly.shapes[n].whole()));
    EXPECT_EQ(one.assembly.grains[n], three.assembly.grains[n]);
  }
}

}  // namespace
}  // namespace reckon
