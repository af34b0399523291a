// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/core/hdf5_types.hpp"

namespace reckon {

/// Hashes of the data that the HDF5 library was given to write. The library can lose it: it holds
/// small datasets back in buffers, and a write that fails while it closes one is not always
/// reported. A file is therefore read back before it is sealed.
class Hdf5Record {
 public:
  /// `type` is that of the numbers, none for texts.
  void add_dataset(const std::string& name, std::optional<Hdf5Number> type,
                   const Hdf5Extents& extents);
  /// Whole rows of a dataset, as they lie in memory.
  void add_rows(const std::string& name, std::uint64_t first, std::string_view bytes);
  /// A text of an object ("/" is the file itself).
  void add_text(const std::string& object, const std::string& name, std::string_view padded);

  /// Reads the file and compares. Throws MachineFailure, about the file `named`, when it holds
  /// anything else.
  void compare(const std::filesystem::path& file, const std::filesystem::path& named) const;

 private:
  struct Rows {
    std::uint64_t first;
    std::uint64_t bytes;
    std::uint64_t digest;
  };
  struct Dataset {
    std::optional<Hdf5Number> type;
    Hdf5Extents extents;
    std::vector<Rows> rows;
  };
  struct Text {
    std::string object;
    std::string name;
    std::string padded;
  };
  [[nodiscard]] static bool holds(std::int64_t file, const std::string& name,
                                  const Dataset& expected);
  [[nodiscard]] static bool holds(std::int64_t dataset, std::uint64_t row_bytes, const Rows& rows);
  [[nodiscard]] static bool holds(std::int64_t file, const Text& text);

  std::map<std::string, Dataset> datasets_;
  std::vector<Text> texts_;
};

}  // namespace reckon
