// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>

#include "reckon/scan/image_filters.hpp"
#include "support/verification_table.hpp"
#include "unit/scan/scan_fixture.hpp"

namespace reckon {
namespace {

/// Grains -> scan with blur and noise -> avatars, against the grains.
TEST(ScanChain, FindsKnownGrainsAtEveryResolution) {
  if (!has_ct_component()) GTEST_SKIP() << "built without the component ct";
  const auto assembly = testing::bumpy_assembly(3, 3, 4);
  testing::VerificationTable table{"scan_chain",
                                   "voxels_per_diameter,volume,inertia,center_voxels,"
                                   "surface_voxels,normal_degrees,missed_contacts,wrong_contacts"};
  for (const double voxels : {20.0, 30.0, 40.0}) {
    SCOPED_TRACE(voxels);
    ScannerSettings settings;
    settings.voxel = 1e-3 / voxels;
    const SimulatedScan scan = scan_assembly(assembly.grains, assembly.reader(), settings);
    const TruthFigures f = testing::run_chain(assembly, scan).figures;
    const double degrees = 180 / std::numbers::pi * f.normal_error;
    EXPECT_EQ(f.grains, 36U);
    EXPECT_EQ(f.found_once, 36U);
    EXPECT_EQ(f.split, 0U);
    EXPECT_EQ(f.joined, 0U);
    EXPECT_NEAR(f.voxels_per_diameter / voxels, 1, 0.1);
    EXPECT_LT(f.volume_error_absolute, voxels > 25 ? 0.006 : 0.01);
    EXPECT_LT(f.inertia_error, 0.4 / voxels);
    EXPECT_LT(f.center_error, 0.1);
    EXPECT_LT(f.surface_error, voxels > 25 ? 0.05 : 0.07);
    EXPECT_LT(degrees, voxels > 25 ? 2.8 : 4);
    EXPECT_GT(f.true_contacts, 10U);
    EXPECT_GE(f.recall(), voxels > 25 ? 0.95 : 0.9);
    EXPECT_GE(f.precision(), voxels > 25 ? 0.95 : 0.9);
    table.row({f.voxels_per_diameter, f.volume_error_absolute, f.inertia_error, f.center_error,
               f.surface_error, degrees, 1 - f.recall(), 1 - f.precision()});
  }
}

}  // namespace
}  // namespace reckon
