// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/scanner.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "../avatar/expect_error.hpp"
#include "reckon/parallel/threads.hpp"
#include "scan_fixture.hpp"

namespace reckon {
namespace {

using testing::sphere;
using testing::TestAssembly;

TestAssembly one_ball(double radius) {
  TestAssembly assembly;
  assembly.shapes = {sphere(radius, 100, 60)};
  assembly.grains.resize(1);
  assembly.grains[0].position = {3, -2, 1};
  return assembly;
}

double sum_of(const GrayVolume& gray) {
  return std::accumulate(gray.values.begin(), gray.values.end(), 0.0);
}

ScannerSettings clean(double voxel) {
  ScannerSettings settings;
  settings.voxel = voxel;
  settings.blur = 0;
  settings.noise = 0;
  settings.void_gray = 0;
  settings.solid_gray = 1;
  return settings;
}

TEST(Scanner, SolidSharesAddUpToTheVolume) {
  const TestAssembly ball = one_ball(1);
  const SimulatedScan scan = scan_assembly(ball.grains, ball.reader(), clean(0.1));
  EXPECT_NEAR(sum_of(scan.gray) * 1e-3 / (4 * std::numbers::pi / 3), 1, 2e-3);
  const Vec3 center = scan.grains[0].position;
  for (int axis = 0; axis < 3; ++axis) {
    const double middle = 0.05 * scan.gray.dims[static_cast<std::size_t>(axis)];
    EXPECT_NEAR(center[axis], middle, 0.051) << "the ball lies in the middle of its volume";
  }
  const auto labelled = std::count(scan.labels.values.begin(), scan.labels.values.end(), 1U);
  EXPECT_NEAR(static_cast<double>(labelled) * 1e-3 / (4 * std::numbers::pi / 3), 1, 0.01);
}

TEST(Scanner, BlurKeepsTheSumAndWidensTheEdge) {
  const TestAssembly ball = one_ball(1);
  ScannerSettings settings = clean(0.1);
  settings.margin = 8;
  const SimulatedScan sharp = scan_assembly(ball.grains, ball.reader(), settings);
  settings.blur = 1.2;
  const SimulatedScan soft = scan_assembly(ball.grains, ball.reader(), settings);
  EXPECT_NEAR(sum_of(soft.gray) / sum_of(sharp.gray), 1, 1e-5);
  const auto between = [](const SimulatedScan& scan) {
    return std::count_if(scan.gray.values.begin(), scan.gray.values.end(),
                         [](float v) { return v > 0.02F && v < 0.98F; });
  };
  EXPECT_GT(between(soft), 3 * between(sharp));
}

TEST(Scanner, NoiseHasItsDeviationAndNoMean) {
  const TestAssembly ball = one_ball(1);
  ScannerSettings settings = clean(0.05);
  const SimulatedScan quiet = scan_assembly(ball.grains, ball.reader(), settings);
  settings.noise = 0.1;
  const SimulatedScan noisy = scan_assembly(ball.grains, ball.reader(), settings);
  double mean = 0;
  double square = 0;
  for (std::size_t v = 0; v < quiet.gray.values.size(); ++v) {
    const double d = noisy.gray.values[v] - quiet.gray.values[v];
    mean += d;
    square += d * d;
  }
  const auto count = static_cast<double>(quiet.gray.values.size());
  EXPECT_NEAR(mean / count, 0, 5 * 0.1 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(square / count), 0.1, 0.002);
}

TEST(Scanner, BeamHardeningDarkensTheAxis) {
  const TestAssembly ball = one_ball(1);
  ScannerSettings settings = clean(0.1);
  settings.beam_hardening = 0.2;
  const SimulatedScan scan = scan_assembly(ball.grains, ball.reader(), settings);
  const auto& dims = scan.gray.dims;
  const float middle = scan.gray.values[scan.gray.index(dims[0] / 2, dims[1] / 2, dims[2] / 2)];
  EXPECT_NEAR(middle, 0.8, 0.01);
}

TEST(Scanner, AnyNumberOfThreadsGivesTheSameBits) {
  const TestAssembly assembly = testing::bumpy_assembly(2, 2, 1);
  ScannerSettings settings;
  settings.voxel = 60e-6;
  const int threads = thread_count();
  set_thread_count(1);
  const SimulatedScan one = scan_assembly(assembly.grains, assembly.reader(), settings);
  set_thread_count(3);
  const SimulatedScan three = scan_assembly(assembly.grains, assembly.reader(), settings);
  set_thread_count(threads);
  EXPECT_TRUE(one.gray.values == three.gray.values);
  EXPECT_TRUE(one.labels.values == three.labels.values);
}

TEST(Scanner, SlabsWithinAnyMemoryGiveTheBitsOfTheWhole) {
  const TestAssembly assembly = testing::bumpy_assembly(2, 1, 3);
  for (const double blur : {0.0, 0.8, 2.5}) {
    ScannerSettings settings;
    settings.voxel = 90e-6;
    settings.blur = blur;
    settings.beam_hardening = 0.1;
    const SimulatedScan whole = scan_assembly(assembly.grains, assembly.reader(), settings);
    const Scanner scanner{assembly.grains, assembly.reader(), settings};
    EXPECT_EQ(scanner.grains(), whole.grains);
    const VoxelDims& dims = scanner.dims();
    const auto layer = static_cast<std::size_t>(dims[0] * dims[1]);
    const auto margins = static_cast<std::size_t>(2 * scanner.margin());
    for (const std::size_t layers : {1U, 2U, 7U, 1000U}) {
      SCOPED_TRACE(::testing::Message() << "blur " << blur << ", slabs of " << layers);
      const Workspace work{{}, 40 * layer * (margins + layers), 0};
      std::vector<float> gray;
      std::vector<std::uint32_t> labels;
      for (const Box& slab : work.slabs(dims, scanner.margin())) {
        EXPECT_LE(slab.dims[2], static_cast<std::int32_t>(layers));
        const ScannedLayers part = scanner.scan(slab);
        EXPECT_EQ(part.gray.box(), slab);
        gray.insert(gray.end(), part.gray.values.begin(), part.gray.values.end());
        labels.insert(labels.end(), part.labels.values.begin(), part.labels.values.end());
      }
      EXPECT_TRUE(gray == whole.gray.values);
      EXPECT_TRUE(labels == whole.labels.values);
    }
    if (margins == 0) continue;
    const Workspace small{{}, 40 * layer * margins, 0};
    test::expect_error([&] { (void)small.slabs(dims, scanner.margin()); },
                       {"--memory", "too small", "layers at once"});
  }
}

TEST(Scanner, RefusesWhatCannotBeScanned) {
  const TestAssembly ball = one_ball(1);
  const auto scan = [&](const ScannerSettings& settings) {
    (void)scan_assembly(ball.grains, ball.reader(), settings);
  };
  test::expect_error([&] { scan(clean(0)); }, {"voxel"});
  test::expect_error([&] { scan(clean(1e-4)); }, {"2^31"});
  ScannerSettings settings = clean(0.1);
  settings.solid_gray = -1;
  test::expect_error([&] { scan(settings); }, {"gray of solid"});
  test::expect_error([&] { (void)scan_assembly({}, ball.reader(), clean(0.1)); }, {"no grains"});
}

}  // namespace
}  // namespace reckon
