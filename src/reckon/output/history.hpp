// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/output/quantities.hpp"

namespace reckon {

/// The header of history.csv, without the end of the line.
[[nodiscard]] std::string history_header(std::span<const HistoryQuantity> quantities);
/// One row, likewise. Numbers are written so that they read back as the same bits.
[[nodiscard]] std::string history_row(std::span<const HistoryQuantity> quantities,
                                      const HistoryRow& row);

/// The reference page docs/reference/history.md: a section for each group of the table.
[[nodiscard]] std::string history_reference_markdown(std::span<const QuantityGroup> groups);
[[nodiscard]] std::string history_reference_markdown();

/// history.csv of a run in progress. Each row is written in one call, so a killed run leaves
/// complete rows.
class HistoryFile {
 public:
  /// Starts a new file, or continues the existing one: then rows for which `keep(step)` is false
  /// are dropped first. Throws Error when the file cannot be written, or has another header.
  HistoryFile(std::filesystem::path path, std::vector<HistoryQuantity> quantities,
              const std::function<bool(std::uint64_t)>& keep = {});
  ~HistoryFile();
  HistoryFile(const HistoryFile&) = delete;
  HistoryFile& operator=(const HistoryFile&) = delete;

  void append(const HistoryRow& row);
  /// Returns once all rows have reached the disk. Another thread may append meanwhile.
  void sync() const;

 private:
  std::filesystem::path path_;
  std::vector<HistoryQuantity> quantities_;
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

/// Holds the header against the table of quantities. Throws Error that names `path` and the column
/// where one stands twice, where there is no step, or where a column that the run must have is
/// missing while another is there that no run has.
void require_columns(const std::filesystem::path& path, const HistoryTable& history,
                     std::span<const QuantityGroup> groups);

/// Numbers of a history by column and row.
class HistoryColumns {
 public:
  explicit HistoryColumns(const HistoryTable& history) : history_{history} {}

  [[nodiscard]] bool has(std::string_view name) const { return place(name).has_value(); }
  /// NaN for a cell without a number. Throws Error that names the column where there is none.
  [[nodiscard]] double at(std::size_t row, std::string_view name) const;

 private:
  [[nodiscard]] std::optional<std::size_t> place(std::string_view name) const;

  const HistoryTable& history_;
};

}  // namespace reckon
