// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/specimen.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "../avatar/expect_error.hpp"
#include "reckon/avatar/random_variates.hpp"
#include "reckon/core/random.hpp"
#include "reckon/scan/doubts.hpp"
#include "reckon/scan/from_scan.hpp"
#include "reckon/scan/image_filters.hpp"
#include "reckon/scan/phases.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

using test::expect_error;

constexpr std::int32_t size = 72;
constexpr double void_gray = 10000;
constexpr double step = 30000;

const Workspace whole{std::filesystem::temp_directory_path(), 0, 0};

/// Balls on a lattice; `gray_of` gives the solid of each, by its number.
GrayVolume ball_shares(const std::function<double(int)>& gray_of) {
  GrayVolume share{{size, size, size}, 1e-5};
  int ball = 0;
  for (int c = 0; c < 4; ++c) {
    for (int b = 0; b < 4; ++b) {
      for (int a = 0; a < 4; ++a, ++ball) {
        const Vec3 center{13.3 + 15.2 * a, 13.6 + 15.2 * b, 13.1 + 15.2 * c};
        const Box near = Box{
            {static_cast<std::int32_t>(center.x), static_cast<std::int32_t>(center.y),
             static_cast<std::int32_t>(center.z)},
            {1, 1, 1}}.widened(11, share.box());
        for_each_voxel(near, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
          const double depth = 7 - norm(Vec3{i + 0.5, j + 0.5, k + 0.5} - center);
          // An edge that is blurred by about a voxel.
          const double filled = 0.5 * std::erfc(-depth / 1.3);
          float& value = share.values[share.index(i, j, k)];
          value = std::max(value, static_cast<float>(gray_of(ball) * filled));
        });
      }
    }
  }
  return share;
}

/// Gray values from shares, changed by `spoil(share, place)`, with noise.
using Spoil = std::function<double(double, const Vec3&)>;
GrayVolume scanned(const GrayVolume& share, const Spoil& spoil, double noise = 0.02) {
  GrayVolume gray = share;
  std::size_t v = 0;
  for_each_voxel(share.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    RandomStream random{3, RandomPurpose::scan_noise, v};
    double value = spoil(share.values[v], {i + 0.5, j + 0.5, k + 0.5});
    if (noise > 0) value += noise * standard_normal(random);
    gray.values[v++] = static_cast<float>(void_gray + step * value);
  });
  return gray;
}
double plain(double share, const Vec3& /*place*/) { return share; }
GrayVolume one_mineral() {
  return ball_shares([](int) { return 1.0; });
}
double from_axis(const Vec3& p) { return std::hypot(p.x - 0.5 * size, p.y - 0.5 * size); }

Specimen clean(const GrayVolume& gray, const SpecimenSettings& settings = {}) {
  return find_specimen(on_disk(gray, whole.folder), settings, whole);
}
/// Root of the mean squared difference from shares, in steps, where `counts`.
double error_of(const Specimen& specimen, const GrayVolume& share,
                const std::function<bool(const Vec3&)>& counts) {
  const GrayVolume gray = specimen.gray.read(share.box());
  // The level of void is free: what counts is its constancy.
  double squares = 0;
  double number = 0;
  std::size_t v = 0;
  for_each_voxel(share.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const std::size_t at = v++;
    if (!counts({i + 0.5, j + 0.5, k + 0.5})) return;
    const double off = (gray.values[at] - void_gray) / step - share.values[at];
    squares += off * off;
    ++number;
  });
  return std::sqrt(squares / number);
}
bool holds(const std::vector<std::string>& remarks, const std::string& text) {
  return std::any_of(remarks.begin(), remarks.end(), [&](const std::string& remark) {
    return remark.find(text) != std::string::npos;
  });
}

class Specimens : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_ct_component()) GTEST_SKIP() << "built without the component ct";
  }
};

TEST_F(Specimens, ACleanScanStaysAsItIs) {
  for (const double noise : {0.0, 0.02, 0.1}) {
    const GrayVolume gray = scanned(one_mineral(), plain, noise);
    const Specimen specimen = clean(gray);
    EXPECT_TRUE(specimen.remarks.empty()) << specimen.remarks.front();
    EXPECT_TRUE(specimen.inside.empty());
    EXPECT_TRUE(specimen.gray.read(gray.box()).values == gray.values);
  }
}

TEST_F(Specimens, AConstantGrayOutsideACircleIsLeftOut) {
  const GrayVolume share = one_mineral();
  const auto in_circle = [](const Vec3& p) { return from_axis(p) < 0.5 * size; };
  for (const double outside : {0.0, 5000.0, 25000.0, 65535.0}) {
    GrayVolume gray = scanned(share, plain);
    std::size_t v = 0;
    for_each_voxel(gray.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      float& value = gray.values[v++];
      if (!in_circle({i + 0.5, j + 0.5, k + 0.5})) value = static_cast<float>(outside);
    });
    const Specimen specimen = clean(gray);
    ASSERT_TRUE(holds(specimen.remarks, "lie outside the reconstruction")) << outside;
    const MaskVolume inside = specimen.outer.read(gray.box());
    const GrayVolume cleaned = specimen.gray.read(gray.box());
    v = 0;
    int wrong = 0;
    for_each_voxel(gray.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const double r = from_axis({i + 0.5, j + 0.5, k + 0.5});
      const std::uint8_t is_inside = inside.values[v];
      const float value = cleaned.values[v++];
      wrong += (r > 0.5 * size && is_inside != 0) || (r < 0.5 * size - 2 && is_inside == 0) ? 1 : 0;
      wrong += is_inside == 0 && std::abs(value - void_gray) > 0.01 * step ? 1 : 0;
    });
    EXPECT_EQ(wrong, 0);
  }
}

TEST_F(Specimens, AMaskThatIsGivenCounts) {
  const std::filesystem::path folder = testing::test_path();
  std::filesystem::create_directories(folder);
  const GrayVolume gray = scanned(one_mineral(), plain);
  GrayVolume mask{gray};
  for_each_voxel(mask.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    mask.values[mask.index(i, j, k)] = i < 36 ? 255.0F : 0.0F;
  });
  write_volume(folder / "mask.npy", mask, VoxelType::uint8);
  SpecimenSettings settings;
  settings.mask = folder / "mask.npy";
  const Specimen specimen = clean(gray, settings);
  EXPECT_TRUE(holds(specimen.remarks, "50.0 % of the volume lie outside the mask"));
  const GrayVolume cleaned = specimen.gray.read(gray.box());
  EXPECT_EQ(cleaned.values[cleaned.index(20, 30, 30)], gray.values[gray.index(20, 30, 30)]);
  EXPECT_NEAR(cleaned.values[cleaned.index(43, 28, 28)], void_gray, 0.01 * step);
  write_volume(folder / "mask.npy", GrayVolume{{5, 5, 5}, 1e-5, 1}, VoxelType::uint8);
  expect_error([&] { (void)clean(gray, settings); }, {"mask.npy", "differ in size"});
  std::filesystem::remove_all(folder);
}

TEST_F(Specimens, TubeAndFloorBecomeVoidAndGrainsBesideThemStay) {
  const GrayVolume share = one_mineral();
  for (const double bright : {0.8, 1.6}) {
    SCOPED_TRACE(bright);
    const auto filled = [](double depth) { return 0.5 * std::erfc(-depth / 1.3); };
    const Spoil spoil = [&](double solid, const Vec3& p) {
      const double r = from_axis(p);
      // The tube's inner surface touches the balls at the sides, the floor those at the bottom.
      const double tube = bright * filled(r - 30.3) * filled(35.3 - r);
      const double floor = r < 31 ? bright * filled(6.0 - p.z) : 0;
      return std::max({solid, tube, floor});
    };
    // Balls that would stand in the tube are not there.
    GrayVolume inner = share;
    for_each_voxel(share.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      if (from_axis({i + 0.5, j + 0.5, k + 0.5}) > 30.3) inner.values[inner.index(i, j, k)] = 0;
    });
    const Specimen specimen = clean(scanned(inner, spoil));
    EXPECT_TRUE(holds(specimen.remarks, "a wall stands along z"));
    EXPECT_TRUE(holds(specimen.remarks, "like a floor"));
    EXPECT_LT(error_of(specimen, inner, [](const Vec3& p) { return from_axis(p) < 26; }), 0.04);
    EXPECT_LT(error_of(specimen, inner, [](const Vec3& p) { return from_axis(p) > 33; }), 0.04);
  }
}

TEST_F(Specimens, ShadingIsLevelled) {
  const GrayVolume share = one_mineral();
  const std::vector<std::pair<const char*, Spoil>> spoils{
      {"half a step added", [](double s, const Vec3& p) { return s + 0.5 * p.x / size; }},
      {"gain of 40 %", [](double s, const Vec3& p) { return s * (1 + 0.4 * (p.y / size - 0.5)); }},
      {"cupping of 40 % with the void", [](double s, const Vec3& p) {
         const double r = from_axis(p) / (0.71 * size);
         return (s + void_gray / step) * (1 - 0.4 * (1 - r * r)) - void_gray / step;
       }}};
  for (const auto& [name, spoil] : spoils) {
    SCOPED_TRACE(name);
    const Specimen specimen = clean(scanned(share, spoil));
    EXPECT_TRUE(holds(specimen.remarks, "shading was levelled"));
    // Levels are those of the middle of the volume: compare with the shares that they give.
    const RoughLevels levels = rough_levels(specimen.gray, {}, whole);
    const GrayVolume gray = specimen.gray.read(share.box());
    double squares = 0;
    for (std::size_t v = 0; v < share.values.size(); ++v) {
      const double off = (gray.values[v] - levels.void_gray) / levels.step() - share.values[v];
      squares += off * off;
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(share.values.size())), 0.07);
  }
}

TEST_F(Specimens, AFaintMineralIsFound) {
  const auto is_faint = [](int ball) { return ball % 3 == 0; };
  const GrayVolume share = ball_shares([&](int ball) { return is_faint(ball) ? 0.4 : 1.0; });
  const GrayOnDisk gray = on_disk(scanned(share, plain), whole.folder);
  const GrayOnDisk quiet = denoised(gray, {}, whole);
  const SolidMask solid = find_solid(quiet, {}, whole);
  ASSERT_EQ(solid.phases.size(), 2U);
  EXPECT_NEAR(solid.phases[0], void_gray + 0.4 * step, 0.03 * step);
  EXPECT_NEAR(solid.phases[1], void_gray + step, 0.03 * step);
  const MaskVolume mask = solid.mask.read(share.box());
  std::size_t wrong = 0;
  std::size_t all = 0;
  const GrayVolume filled = one_mineral();
  for (std::size_t v = 0; v < mask.values.size(); ++v) {
    wrong += (mask.values[v] != 0) != (filled.values[v] > 0.5F) ? 1U : 0U;
    all += filled.values[v] > 0.5F ? 1U : 0U;
  }
  EXPECT_LT(static_cast<double>(wrong), 0.06 * static_cast<double>(all));
  // One mineral, however noisy, is one phase.
  const GrayOnDisk noisy = on_disk(scanned(one_mineral(), plain, 0.1), whole.folder);
  EXPECT_TRUE(find_solid(denoised(noisy, {}, whole), {}, whole).phases.empty());
}

/// Grays that the user gives count as those that are found.
TEST_F(Specimens, GraysOfPhasesMayBeGiven) {
  const GrayVolume share = ball_shares([](int ball) { return ball % 3 == 0 ? 0.4 : 1.0; });
  const GrayOnDisk quiet = denoised(on_disk(scanned(share, plain), whole.folder), {}, whole);
  const SolidMask found = find_solid(quiet, {}, whole);
  MaskSettings settings;
  settings.grays = {void_gray, void_gray + 0.4 * step, void_gray + step};
  const SolidMask given = find_solid(quiet, settings, whole);
  EXPECT_EQ(given.phases, std::vector<double>(settings.grays.begin() + 1, settings.grays.end()));
  const MaskVolume a = found.mask.read(share.box());
  const MaskVolume b = given.mask.read(share.box());
  std::size_t solid = 0;
  std::size_t other = 0;
  for (std::size_t v = 0; v < a.values.size(); ++v) {
    solid += a.values[v] != 0 ? 1U : 0U;
    other += a.values[v] != b.values[v] ? 1U : 0U;
  }
  EXPECT_LT(static_cast<double>(other), 0.02 * static_cast<double>(solid));
  // Without the faint one, its balls are void.
  settings.grays = {void_gray, void_gray + step};
  const MaskVolume bright = find_solid(quiet, settings, whole).mask.read(share.box());
  std::size_t left = 0;
  for (const auto value : bright.values) left += value != 0 ? 1U : 0U;
  EXPECT_LT(static_cast<double>(left), 0.8 * static_cast<double>(solid));
  for (const std::vector<double>& wrong : {std::vector<double>{1}, {2, 1}, {1, 1, 2}}) {
    EXPECT_THROW((void)given_phases(wrong), Error);
  }
}

TEST_F(Specimens, BlocksGiveTheBitsOfTheWhole) {
  const GrayVolume share = ball_shares([](int ball) { return ball % 3 == 0 ? 0.4 : 1.0; });
  GrayVolume gray = scanned(share, [](double s, const Vec3& p) { return s + p.x / size; });
  for_each_voxel(gray.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    if (from_axis({i + 0.5, j + 0.5, k + 0.5}) > 36) gray.values[gray.index(i, j, k)] = 0;
  });
  const auto solve = [&](const Workspace& work) {
    const Specimen specimen = find_specimen(on_disk(gray, work.folder), {}, work);
    const SolidMask solid =
        find_solid(denoised(specimen.gray, {}, work), {}, work, specimen.inside);
    return std::pair{specimen.gray.read(gray.box()).values, solid.mask.read(gray.box()).values};
  };
  EXPECT_TRUE(solve(whole) == solve({whole.folder, 40 * 200000, 8}));
}

/// Two boxes side by side, as a crack leaves them, and a ball beside.
TEST_F(Specimens, HalvesAlongACrackAreDoubtful) {
  LabelVolume labels{{40, 24, 24}, 1e-5};
  for_each_voxel(labels.box(), [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    std::uint32_t& label = labels.values[labels.index(i, j, k)];
    const bool beside = j >= 6 && j < 18 && k >= 6 && k < 18;
    if (beside && i >= 3 && i < 13) label = 1;
    if (beside && i >= 14 && i < 22) label = 2;
    if (norm(Vec3{i + 0.5, j + 0.5, k + 0.5} - Vec3{30.5, 12, 12}) < 7) label = 3;
  });
  const LabelsOnDisk stored = on_disk(labels, whole.folder);
  const auto doubts = doubtful_splits(stored, measure_labels(stored, whole), whole);
  ASSERT_EQ(doubts.size(), 1U);
  EXPECT_EQ(doubts[0].a, 1U);
  EXPECT_EQ(doubts[0].b, 2U);
  EXPECT_NEAR(doubts[0].voxel[0], 13, 1);
  EXPECT_EQ(doubtful_joins({{1, 0.95, {}}, {2, 0.8, {1, 2, 3}}, {2, 0.7, {4, 5, 6}}}).size(), 1U);
  EXPECT_EQ(doubtful_joins({{2, 0.8, {1, 2, 3}}, {2, 0.7, {4, 5, 6}}})[0].voxel,
            (VoxelDims{4, 5, 6}));
}

TEST_F(Specimens, TheCircleOfTheSharedCasesKeepsTheVolumes) {
  const std::filesystem::path file = std::filesystem::path{RECKON_SOURCE_DIR} /
                                     "../shared/cases/reconstruction-circle/mask_void10000_1.npy";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no " << file;
  const std::filesystem::path folder = testing::test_path();
  std::filesystem::create_directories(folder);
  SegmentSettings settings;
  settings.volume = {file, 1e-3, {}};
  const Segmentation scan = segment_scan(settings, folder, ScanStage::choose, {}, {});
  EXPECT_TRUE(holds(scan.remarks, "outside the reconstruction"));
  AvatarSettings avatars;
  avatars.resolution.voxel_size = 1e-3;
  const ScannedAssembly assembly =
      make_avatars({scan.raw, scan.denoised, scan.labels, scan.levels, scan.work}, scan.grains,
                   scan.choice.kept, avatars, {});
  std::vector<double> volumes;
  for (const AvatarQuality& quality : assembly.quality) volumes.push_back(1e9 * quality.volume);
  std::sort(volumes.begin(), volumes.end());
  ASSERT_EQ(volumes.size(), 3U);
  const std::vector<double> right{950.8, 1376.1, 2309.6};
  // The largest ball stands a little into the circle's edge.
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_NEAR(volumes[n] / right[n], 1, n == 2 ? 0.012 : 0.005);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace reckon
