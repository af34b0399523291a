// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
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

/// All of `reckon grains from-scan` on a scan in memory.
struct ChainResult {
  LabelVolume labels;
  ScannedAssembly assembly;
  TruthFigures figures;
};
inline ChainResult run_chain(const TestAssembly& truth, const SimulatedScan& scan) {
  Segmentation parts;
  parts.raw = scan.gray;
  parts.denoised = denoised(parts.raw, {});
  SolidMask solid = find_solid(parts.denoised, {});
  parts.labels = split_grains(solid.mask, {}, &parts.raw, solid.levels).labels;
  parts.grains = measure_labels(parts.labels);
  parts.choice = choose_grains(parts.grains, false, 500);
  const LabelVolume territories = grown(parts.labels, territory_layers);
  AvatarSettings settings;
  settings.resolution.voxel_size = scan.gray.voxel;
  ChainResult result;
  result.assembly =
      make_avatars({&parts.raw, &parts.denoised, &parts.labels, &territories, solid.levels},
                   parts.grains, parts.choice.kept, settings, {});
  result.figures =
      compare_with_truth({truth.shapes, scan.grains, scan.labels}, result.assembly, parts.labels);
  result.labels = std::move(parts.labels);
  return result;
}

}  // namespace reckon::testing
