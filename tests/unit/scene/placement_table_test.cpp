// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/placement_table.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "support/test_path.hpp"

namespace reckon {
namespace {

class PlacementTable : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }
  std::filesystem::path file_{testing::test_path()};

  std::string fault(const std::string& text) {
    write_file(file_, text);
    try {
      (void)read_placement(file_, 3);
    } catch (const Error& error) {
      return error.what();
    }
    return "no fault";
  }
};

TEST_F(PlacementTable, GivesBackWhatWasWritten) {
  std::vector<GrainState> grains(2);
  grains[0].position = {1.0 / 3, -2e-9, 5e7};
  grains[0].orientation = normalized(Quaternion{0.1, 0.7, -0.3, 0.2});
  grains[1].id = GrainId{1};
  grains[1].shape = ShapeId{2};
  write_placement(file_, grains);
  const auto back = read_placement(file_, 3);
  ASSERT_EQ(back.size(), 2U);
  EXPECT_EQ(back[0].position, grains[0].position);
  EXPECT_DOUBLE_EQ(back[0].orientation.x, grains[0].orientation.x);
  EXPECT_EQ(back[1], grains[1]);
}

TEST_F(PlacementTable, FaultsNameTheGrain) {
  EXPECT_NE(fault("0,0,0,0,1,0,0,0\n3,0,0,0,1,0,0,0\n").find("grain 2: there is no such shape"),
            std::string::npos);
  EXPECT_NE(fault("0.5,0,0,0,1,0,0,0\n").find("no such shape"), std::string::npos);
  EXPECT_NE(fault("0,0,0,0,0,0,0,0\n").find("no rotation"), std::string::npos);
  EXPECT_NE(fault("0,0,0,0,1,0,0\n").find("7 numbers"), std::string::npos);
}

}  // namespace
}  // namespace reckon
