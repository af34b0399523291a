// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "reckon/core/stopwatch.hpp"
#include "reckon/scan/from_scan.hpp"
#include "reckon/scan/scan_avatars.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon::app {

/// The report of `reckon grains from-scan`: lines on the terminal, tables and a JSON file in its
/// folder.
class ScanReport {
 public:
  explicit ScanReport(std::filesystem::path folder);

  void begin(const std::string& stage);
  /// What was assumed, or is doubtful.
  void remark(const std::string& text);
  void segmented(const Segmentation& scan, ScanStage last);
  /// Also writes quality.csv, contacts.csv and the scene that relaxes the assembly.
  void avatars(const ScannedAssembly& assembly, const Segmentation& scan);
  /// Doubtful splits and joins, in doubtful.csv and in pictures; what speaks against the result.
  void doubts(const StoredScan& stored, const Segmentation& scan, const ScannedAssembly& assembly);
  /// Compares with the folder that `reckon grains scan` wrote.
  void compare(const std::string& truth, const ScannedAssembly& assembly, const Segmentation& scan);
  /// Writes report.json.
  void finish();

 private:
  void end_stage();

  std::filesystem::path folder_;
  JsonWriter json_;
  std::string stage_;
  Stopwatch since_begin_;  // of the stage
  std::vector<std::pair<std::string, double>> seconds_;
  std::vector<std::string> remarks_;
};

}  // namespace reckon::app
