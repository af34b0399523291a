// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace reckon::testing {

/// The legacy data set beside the project, with its morphologies unpacked into a folder of the
/// test's own (tests run at the same time). Skips where it, or tar with xz, is missing.
class LegacyDataTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(data_ / "morphologies.tar.xz")) {
      GTEST_SKIP() << "the legacy592 data set is not beside the project";
    }
    std::filesystem::create_directories(morphologies_);
    const std::string command = "tar -xJf '" + (data_ / "morphologies.tar.xz").string() + "' -C '" +
                                morphologies_.string() + "'";
    if (std::system(command.c_str()) != 0) GTEST_SKIP() << "tar could not unpack the data set";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path data_ =
      std::filesystem::path{RECKON_SOURCE_DIR} / "../shared/data/legacy592";
  std::filesystem::path folder_ = std::filesystem::path{::testing::TempDir()} /
                                  (std::string{"reckon_legacy592_"} +
                                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
  std::filesystem::path morphologies_ = folder_ / "morphologies";
};

}  // namespace reckon::testing
