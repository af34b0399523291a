// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/test_path.hpp"

namespace reckon::testing {

/// A folder with an empty shape library in it, so that scenes can name one.
class SceneTextTest : public ::testing::Test {
 protected:
  void SetUp() override {
    directory_ = test_path();
    std::filesystem::create_directories(directory_);
    std::ofstream{directory_ / "sand.h5"};
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  static constexpr const char* sound =
      "contact.normal_stiffness = 1e9\n"
      "time.steps = 10\n"
      "grains = [{ library = 'sand.h5', place = [{ position = [0, 0, 0] }] }]\n";
  std::filesystem::path directory_;
};

}  // namespace reckon::testing
