// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>

namespace reckon::testing {

/// Rows of a verification case. Written as CSV to the folder that the environment variable
/// RECKON_VERIFICATION_OUT names, and nowhere without it: the tests that assert the figures are the
/// ones that make the tables in docs/verification.
class VerificationTable {
 public:
  VerificationTable(const std::string& name, const std::string& header) {
    const char* folder = std::getenv("RECKON_VERIFICATION_OUT");
    if (folder == nullptr) return;
    std::filesystem::create_directories(folder);
    file_.open(std::filesystem::path{folder} / (name + ".csv"));
    file_.precision(8);
    file_ << header << '\n';
  }
  void row(std::initializer_list<double> values) {
    bool first = true;
    for (const double value : values) {
      file_ << (first ? "" : ",") << value;
      first = false;
    }
    file_ << '\n';
  }

 private:
  std::ofstream file_;
};

}  // namespace reckon::testing
