// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "reckon/avatar/library_file.hpp"
#include "reckon/core/hdf5_file.hpp"

namespace reckon {

/// Reads a library's table at once and its shapes one by one.
class LibraryReader {
 public:
  explicit LibraryReader(const std::filesystem::path& path);

  [[nodiscard]] std::size_t size() const { return table_.size(); }
  [[nodiscard]] const Provenance& provenance() const { return provenance_; }
  /// All shapes without their arrays.
  [[nodiscard]] const ShapeLibrary& table() const { return table_; }
  [[nodiscard]] ShapeSummary summary(std::size_t s) const;
  [[nodiscard]] Shape shape(std::size_t s) const;

 private:
  [[nodiscard]] std::string place(std::size_t s) const {
    return file_.path().string() + ", shape " + table_[s].name;
  }
  /// Of its grid: values or words.
  [[nodiscard]] std::uint64_t rows(std::size_t s) const {
    return first_value_[s + 1] - first_value_[s];
  }
  /// What dims must make. Those of a band follow from the dims alone; 0: no grid is as large.
  [[nodiscard]] std::uint64_t grid_values(std::size_t s) const;
  /// A column of a shape's nodes.
  [[nodiscard]] std::vector<double> column(const char* name, std::size_t s) const;
  /// A table of first rows that rises from 0 to the length of `data`.
  [[nodiscard]] std::vector<std::uint64_t> read_first_rows(const std::string& name,
                                                           const std::string& data) const;

  Hdf5Reader file_;
  ShapeLibrary table_;  // all but grids and nodes
  Provenance provenance_;
  std::vector<std::uint64_t> digest_;
  std::vector<std::uint64_t> first_value_;
  std::vector<std::uint64_t> first_node_;
};

}  // namespace reckon
