// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Real crushed-stone grains as spherical-harmonic coefficients, against the table that was measured
// with them. Skips where the data set does not lie beside the project.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "reckon/avatar/degree_table.hpp"
#include "reckon/avatar/shape_sources.hpp"
#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/core/file.hpp"

namespace reckon {
namespace {

struct Measured {
  std::string file;
  double volume{0};  // [m^3]
  double area{0};    // [m^2]
  double length{0};  // [m]
};

class Aggregate : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path{RECKON_SOURCE_DIR} / "../shared/data/aggregate57";
    if (!std::filesystem::exists(folder_ / "FDOT-57-geom.dat")) {
      GTEST_SKIP() << "the aggregate57 data set is not beside the project";
    }
    const std::string table = (folder_ / "FDOT-57-geom.dat").string();
    degrees_ = parse_degree_table(read_file(table), table);
    std::ifstream stream{table};
    std::string line;
    std::getline(stream, line);
    const std::vector<std::string> header = words(line);
    const auto column = [&](const char* name) {
      return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) -
                                      header.begin());
    };
    while (std::getline(stream, line)) {
      const std::vector<std::string> row = words(line);
      if (row.size() < header.size() || !std::filesystem::exists(folder_ / "anm" / row[0]))
        continue;
      measured_.push_back({row[0], 1e-9 * std::stod(row[column("volume")]),
                           1e-6 * std::stod(row[column("surf_area")]),
                           1e-3 * std::stod(row[column("length(mm)")])});
    }
  }

  static std::vector<std::string> words(const std::string& line) {
    std::istringstream stream{line};
    std::vector<std::string> all;
    for (std::string word; stream >> word;) all.push_back(word);
    return all;
  }

  /// Builds every `stride`-th grain and compares it with its line of the table.
  void compare(std::size_t stride) {
    std::vector<ShapeSource> sources;
    std::vector<Measured> expected;
    for (std::size_t m = 0; m < measured_.size(); m += stride) {
      sources.push_back(harmonics_file_source(folder_ / "anm" / measured_[m].file, 1e-3,
                                              degrees_.at(measured_[m].file)));
      expected.push_back(measured_[m]);
    }
    ASSERT_GE(sources.size(), 4U);
    const ShapeLibrary library = build_library(sources, {.voxels_per_diameter = 40});
    double worst_volume = 0;
    double worst_area = 0;
    for (std::size_t s = 0; s < library.size(); ++s) {
      double area = 0;
      for (const double a : library[s].nodes.area) area += a;
      const double volume_error = std::abs(library[s].mass.volume / expected[s].volume - 1);
      const double area_error = std::abs(area / expected[s].area - 1);
      EXPECT_LT(volume_error, 0.015) << expected[s].file;
      EXPECT_LT(area_error, 0.02) << expected[s].file;
      // Inside the zero of the interpolated grid. The stored volume is that of the mesh's chords.
      const double contact = solid_properties(extract_surface(library[s].level_set)).volume;
      EXPECT_NEAR(contact / library[s].mass.volume, 1, 2e-3) << expected[s].file;
      worst_volume = std::max(worst_volume, volume_error);
      worst_area = std::max(worst_area, area_error);
    }
    RecordProperty("worst_volume_error", std::to_string(worst_volume));
    RecordProperty("worst_area_error", std::to_string(worst_area));
  }

  std::filesystem::path folder_;
  std::map<std::string, std::uint32_t> degrees_;
  std::vector<Measured> measured_;
};

using AggregateSample = Aggregate;
using AggregateWhole = Aggregate;

TEST_F(AggregateSample, SomeGrainsHaveTheirMeasuredVolumeAndArea) { compare(13); }
TEST_F(AggregateWhole, AllGrainsHaveTheirMeasuredVolumeAndArea) { compare(1); }

}  // namespace
}  // namespace reckon
