// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "reckon/core/error.hpp"
#include "reckon/scan/doubts.hpp"
#include "reckon/scan/image_filters.hpp"
#include "support/test_path.hpp"
#include "unit/scan/scan_fixture.hpp"

namespace reckon {
namespace {

/// A scan that something spoils, and words of the remark that should then name the cause.
struct Condition {
  std::string name;
  std::function<void(ScannerSettings&)> spoil;
  std::string cause;
};

std::vector<Condition> conditions() {
  using S = ScannerSettings;
  return {{"clean", [](S&) {}, ""},
          {"tube, bright", [](S& s) { s.artefacts.tube = 1.5; }, "wall stands along z"},
          {"floor", [](S& s) { s.artefacts.floor = 1.0; }, "floor"},
          {"tube and floor",
           [](S& s) {
             s.artefacts.tube = 1.5;
             s.artefacts.floor = 1.5;
           },
           "wall stands along z"},
          {"circle, zeros outside",
           [](S& s) {
             s.artefacts.circle = 1;
             s.artefacts.circle_gray = 0;
           },
           "outside the reconstruction"},
          {"half a step added", [](S& s) { s.artefacts.shading = 0.5; }, "shading was levelled"},
          {"a step added", [](S& s) { s.artefacts.shading = 1; }, "shading was levelled"},
          {"gain of 40 %", [](S& s) { s.artefacts.gain_shading = 0.4; }, "shading was levelled"},
          {"cupping of 40 %, solid", [](S& s) { s.beam_hardening = 0.4; }, "shading was levelled"},
          {"cupping of 40 %, with void", [](S& s) { s.artefacts.cupping = 0.4; },
           "shading was levelled"},
          {"rings of 10 %", [](S& s) { s.artefacts.rings = 0.1; }, "gray varies"},
          {"second mineral at 40 %", [](S& s) { s.artefacts.mineral_share = 0.35; }, "phases"},
          {"cracks of 2 voxels",
           [](S& s) {
             s.artefacts.crack_share = 0.3;
             s.artefacts.crack_width = 2;
           },
           "along a crack"},
          {"blur of 1.8 voxels", [](S& s) { s.blur = 1.8; }, "blurred"},
          {"noise of 20 %", [](S& s) { s.noise = 0.2; }, "noise"}};
}

/// Grains in layers of twelve, which fit into a tube.
testing::TestAssembly round_assembly(int layers) {
  testing::TestAssembly assembly = testing::bumpy_assembly(4, 4, layers);
  std::vector<GrainState> round;
  for (std::size_t n = 0; n < assembly.grains.size(); ++n) {
    const std::size_t i = n % 4;
    const std::size_t j = n / 4 % 4;
    if ((i == 0 || i == 3) && (j == 0 || j == 3)) continue;
    round.push_back(assembly.grains[n]);
    round.back().id = GrainId{static_cast<std::uint32_t>(round.size() - 1)};
  }
  assembly.grains = round;
  return assembly;
}

struct Outcome {
  TruthFigures figures;
  std::vector<std::string> remarks;

  [[nodiscard]] std::uint32_t lost() const { return figures.grains - figures.found_once; }
  [[nodiscard]] bool names(const std::string& cause) const {
    return !cause.empty() &&
           std::any_of(remarks.begin(), remarks.end(), [&](const std::string& remark) {
             return remark.find(cause) != std::string::npos;
           });
  }
  /// At most twice the errors of a clean scan; of few grains one more may be lost.
  [[nodiscard]] bool is_near(const Outcome& clean) const {
    return lost() <= std::max(1U, 2 * clean.lost()) &&
           figures.volume_error_absolute <= 2 * clean.figures.volume_error_absolute + 1e-3 &&
           1 - figures.recall() <= 2 * (1 - clean.figures.recall()) + 0.02;
  }
};

Outcome run(const testing::TestAssembly& truth, const ScannerSettings& scanner) {
  const std::filesystem::path folder = testing::test_path();
  std::filesystem::create_directories(folder);
  const SimulatedScan scan = scan_assembly(truth.grains, truth.reader(), scanner);
  write_volume(folder / "scan.npy", scan.gray, VoxelType::float32);
  SegmentSettings settings;
  settings.volume = {folder / "scan.npy", scanner.voxel, {}};
  Outcome outcome;
  try {
    const Segmentation found = segment_scan(settings, folder, ScanStage::choose, {}, {});
    AvatarSettings avatars;
    avatars.resolution.voxel_size = scanner.voxel;
    const StoredScan stored{found.raw, found.denoised, found.labels, found.levels, found.work};
    const ScannedAssembly assembly =
        make_avatars(stored, found.grains, found.choice.kept, avatars, {});
    outcome.figures = compare_with_truth({truth.shapes, scan.grains, on_disk(scan.labels, folder)},
                                         assembly, found.labels, found.work);
    outcome.remarks = found.remarks;
    const auto splits = doubtful_splits(found.labels, found.grains, found.work);
    for (const auto& list : {check_doubts(splits, assembly.shapes.size()),
                             check_packing(assembly, found.grains, found.choice, found.levels),
                             check_scan(stored, found.mask, assembly.spread)}) {
      outcome.remarks.insert(outcome.remarks.end(), list.begin(), list.end());
    }
  } catch (const Error& error) {
    outcome.remarks.emplace_back(error.what());
    outcome.figures.grains = static_cast<std::uint32_t>(truth.grains.size());
    outcome.figures.true_contacts = 1;
  }
  std::filesystem::remove_all(folder);
  return outcome;
}

/// Writes a row per condition into scan_artefacts.csv, if RECKON_VERIFICATION_OUT names a folder.
void check_all(int layers, double voxels) {
  if (!has_ct_component()) GTEST_SKIP() << "built without the component ct";
  const testing::TestAssembly truth = round_assembly(layers);
  std::string text = "condition,found_once,split,joined,volume,recall,precision,near,named\n";
  Outcome clean;
  for (const Condition& condition : conditions()) {
    SCOPED_TRACE(condition.name);
    ScannerSettings scanner;
    scanner.voxel = 1e-3 / voxels;
    scanner.margin = 12;
    condition.spoil(scanner);
    const Outcome outcome = run(truth, scanner);
    if (condition.cause.empty()) clean = outcome;
    const TruthFigures& f = outcome.figures;
    const bool near = outcome.is_near(clean);
    const bool named = outcome.names(condition.cause);
    const std::string row = fmt::format(
        "\"{}\",{} of {},{},{},{:.2f} %,{:.1f} %,{:.1f} %,{},{}\n", condition.name, f.found_once,
        f.grains, f.split, f.joined, 100 * f.volume_error_absolute, 100 * f.recall(),
        100 * f.precision(), near ? "yes" : "no", named ? "yes" : "no");
    fmt::print("{}", row);
    std::fflush(stdout);
    text += row;
    std::string all;
    for (const std::string& remark : outcome.remarks) all += "\n  " + remark;
    EXPECT_TRUE(near || named) << all;
  }
  const char* const folder = std::getenv("RECKON_VERIFICATION_OUT");
  if (folder == nullptr) return;
  std::ofstream{std::filesystem::path{folder} / "scan_artefacts.csv"} << text;
}

TEST(ScanArtefacts, AreTakenOutOrNamed) {
  check_all(RECKON_ARTEFACT_LAYERS, RECKON_ARTEFACT_VOXELS);
}

}  // namespace
}  // namespace reckon
