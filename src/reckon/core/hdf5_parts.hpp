// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "reckon/core/hdf5_file.hpp"
#include "reckon/core/hdf5_handle.hpp"

/// Common parts of the writer and the reader of sealed HDF5 files. Handles are std::int64_t, as in
/// hdf5_handle.hpp.
namespace reckon {

inline constexpr std::size_t longest_hdf5_text = 4096;

[[nodiscard]] std::int64_t hdf5_native_type(Hdf5Number type);

/// A text of exactly `size` bytes, padded with NUL.
[[nodiscard]] Hdf5Handle hdf5_text_type(std::size_t size);

[[nodiscard]] Hdf5Extents hdf5_extents(std::int64_t dataset);

/// Numbers in one row.
[[nodiscard]] std::uint64_t hdf5_row_size(const Hdf5Extents& extents);

/// Dataspaces in file and memory for a run of whole rows.
struct Hdf5Rows {
  Hdf5Handle file_space;
  Hdf5Handle memory_space;
  bool good;  ///< false: there are no such rows
};
/// The rows from `first` on that hold `count` numbers.
[[nodiscard]] Hdf5Rows hdf5_rows(std::int64_t dataset, std::uint64_t first, std::uint64_t count);

/// Opens a dataset whose values lie in its own file; the handle is not valid where there is none. A
/// dataset may name other files that hold its values ("external storage", "virtual datasets"), and
/// a link may lead into another file: a file from elsewhere could thus expose private files of the
/// reader. Throws Error then.
[[nodiscard]] Hdf5Handle hdf5_open_dataset(std::int64_t file, const std::string& name,
                                           const std::filesystem::path& path);

/// The errno that the system gave in the last call that failed, as far as HDF5 reports it; 0
/// otherwise. Call it before the next call of HDF5.
[[nodiscard]] int hdf5_error_number();

}  // namespace reckon
