// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace reckon::testing {

/// A path for the current test alone, even where the same test runs twice at a time. Nothing is
/// created there.
inline std::filesystem::path test_path() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  return std::filesystem::path{::testing::TempDir()} /
         (std::string{info->test_suite_name()} + "." + info->name() + "." +
          std::to_string(::getpid()));
}

}  // namespace reckon::testing
