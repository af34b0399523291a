// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reckon/analysis/sample.hpp"
#include "reckon/boundary/wall.hpp"
#include "reckon/simulation/measurement.hpp"

namespace reckon {

/// One column of history.csv, for the header and for the reference.
struct HistoryColumn {
  std::string name;  ///< with the unit at its end, e.g. "time_s"
  std::string meaning;
};

/// Which columns a run has.
struct HistoryLayout {
  std::span<const Wall> walls;
  bool membrane{false};
  bool cell{false};
  bool bonds{false};
  bool stages{false};  ///< the number of the stage
  bool sample{false};  ///< what SampleMeasurement holds
};

/// What a row tells.
struct HistoryRow {
  const Measurement& measurement;
  double energy_at_start{0};                 ///< EnergyBudget::total() at step 0 [J]
  bool membrane{false};                      ///< whether the layout has it
  const CellState* cell{nullptr};            ///< none where the layout has none
  bool bonds{false};                         ///< likewise
  std::optional<std::uint64_t> stage{};      ///< counted from 1
  const SampleMeasurement* sample{nullptr};  ///< none where the layout has none
};

/// The columns of a run: fixed ones, three per wall, then those of membrane, cell, bonds, stages
/// and sample.
[[nodiscard]] std::vector<HistoryColumn> history_columns(const HistoryLayout& layout);

/// The reference page docs/reference/history.md.
[[nodiscard]] std::string history_reference_markdown();

/// One row, without the end of the line. Numbers are written so that they read back as the same
/// bits.
[[nodiscard]] std::string history_row(const HistoryRow& told);

/// history.csv of a run under way. Each row is handed to the system in one piece, so a killed run
/// leaves whole rows.
class HistoryFile {
 public:
  /// Starts a new file, or goes on with the one there: then rows for which `keep(step)` is false
  /// are dropped first. Throws Error when the file cannot be written, or has another header.
  HistoryFile(std::filesystem::path path, const HistoryLayout& layout,
              const std::function<bool(std::uint64_t)>& keep = {});
  ~HistoryFile();
  HistoryFile(const HistoryFile&) = delete;
  HistoryFile& operator=(const HistoryFile&) = delete;

  void append(const HistoryRow& row);
  /// Returns once all rows have reached the disk. Another thread may append meanwhile.
  void sync() const;

 private:
  std::filesystem::path path_;
  int descriptor_{-1};
};

/// history.csv as text cells.
struct HistoryTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// Reads history.csv; a last line without its end, as a power failure may leave it, is left out.
/// Throws Error when the file cannot be read or a row has not as many cells as the header.
[[nodiscard]] HistoryTable read_history(const std::filesystem::path& path);

}  // namespace reckon
