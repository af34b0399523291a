// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <filesystem>
#include <numbers>

#include "reckon/avatar/random_variates.hpp"
#include "reckon/core/random.hpp"
#include "reckon/scan/from_scan.hpp"
#include "reckon/scan/scan_truth.hpp"
#include "reckon/scan/scanner.hpp"
#include "support/test_shapes.hpp"

namespace reckon::testing {

/// Bumpy grains of about 1 mm in random orientations on a lattice, near enough that many touch.
struct TestAssembly {
  ShapeLibrary shapes;
  std::vector<GrainState> grains;

  [[nodiscard]] ReadShape reader() const {
    return [this](ShapeId shape) { return shapes.at(shape.get()); };
  }
};

inline TestAssembly bumpy_assembly(int nx, int ny, int nz) {
  TestAssembly assembly;
  assembly.shapes = {bumpy_grain(0.55e-3, 900, 40), bumpy_grain(0.6e-3, 900, 40)};
  RandomStream random{5, RandomPurpose::orientation, 0};
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const auto n = static_cast<std::uint32_t>(assembly.grains.size());
        GrainState grain;
        grain.id = GrainId{n};
        grain.shape = ShapeId{n % 2};
        grain.position = 1.01e-3 * Vec3{i + 0.1 * random.uniform(), j + 0.1 * random.uniform(),
                                        k + 0.1 * random.uniform()};
        grain.orientation =
            normalized(Quaternion{standard_normal(random), standard_normal(random),
                                  standard_normal(random), standard_normal(random)});
        assembly.grains.push_back(grain);
      }
    }
  }
  return assembly;
}

/// All of `reckon grains from-scan` on a simulated scan.
struct ChainResult {
  LabelVolume labels;
  ScannedAssembly assembly;
  TruthFigures figures;
  BlockFigures blocks;
};
inline ChainResult run_chain(const TestAssembly& truth, const SimulatedScan& scan,
                             const Workspace& work = {std::filesystem::temp_directory_path(), 0,
                                                      0}) {
  const GrayOnDisk raw = on_disk(scan.gray, work.folder);
  const GrayOnDisk quiet = denoised(raw, {}, work);
  const SolidMask solid = find_solid(quiet, {}, work);
  const SplitGrains split = split_grains(solid.mask, {}, &raw, solid.levels, work);
  const auto grains = measure_labels(split.labels, work);
  AvatarSettings settings;
  settings.resolution.voxel_size = scan.gray.voxel;
  ChainResult result;
  result.assembly = make_avatars({raw, quiet, split.labels, solid.levels, work}, grains,
                                 choose_grains(grains, false, 500).kept, settings, {});
  result.figures =
      compare_with_truth({truth.shapes, scan.grains, on_disk(scan.labels, work.folder)},
                         result.assembly, split.labels, work);
  result.labels = split.labels.read(split.labels.box());
  result.blocks = split.blocks;
  return result;
}

}  // namespace reckon::testing
