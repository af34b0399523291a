// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/core/file.hpp"
#include "reckon/core/hdf5_record.hpp"
#include "reckon/core/hdf5_types.hpp"

namespace reckon {

/// Sealed HDF5 files: files that are stored permanently (shape libraries, checkpoints) and must be
/// verified when they are read.
///
///   byte 0    a seal of 512 bytes (HDF5's "user block"), plain text: what the file is, its
///   version,
///             its length and a hash of it all
///   byte 512  an ordinary HDF5 file; h5dump, h5py and others read it as it is
///
/// The seal is checked before the HDF5 library opens the file, because some damaged files crash
/// that library.

/// The kind of a sealed file.
struct Hdf5Kind {
  std::string name;          ///< one line of text, e.g. "shape library"
  std::uint32_t version{1};  ///< of the layout
};

/// Writes a sealed HDF5 file under a temporary name; finish() reads it back, compares it with what
/// was to be written, seals it and puts it in place. Every failure throws Error with the file's
/// name, MachineFailure where the disk is the reason. Dataset names are paths ("/grid/values");
/// missing groups are made.
class Hdf5Writer {
 public:
  Hdf5Writer(const std::filesystem::path& target, Hdf5Kind kind);
  ~Hdf5Writer();
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// A whole dataset; `values` has the product of `extents` numbers. `unit` is stored as the
  /// attribute of that name, "1" for pure numbers.
  template <Hdf5Storable Number>
  void write(const std::string& name, const std::vector<Number>& values, const Hdf5Extents& extents,
             std::string_view unit) {
    create(name, hdf5_number<Number>(), extents, unit);
    write_rows(name, 0, std::span<const Number>{values});
  }
  /// A dataset to be filled with write_rows.
  void create(const std::string& name, Hdf5Number type, const Hdf5Extents& extents,
              std::string_view unit);
  /// Whole rows from row `first` on.
  template <Hdf5Storable Number>
  void write_rows(const std::string& name, std::uint64_t first, std::span<const Number> values) {
    write_raw(name, first, hdf5_number<Number>(), values.data(), values.size());
  }
  /// One text per row; texts must not hold NUL characters.
  void write_texts(const std::string& name, const std::vector<std::string>& texts);
  /// A note on the whole file, as a text attribute of the root group.
  void write_note(const std::string& name, const std::string& text);

  /// Nothing under the file's own name changes unless every byte has arrived.
  void finish();

  [[nodiscard]] const std::filesystem::path& target() const { return pending_.target(); }

 private:
  void write_raw(const std::string& name, std::uint64_t first, Hdf5Number type, const void* values,
                 std::uint64_t count);
  void write_text_attribute(std::int64_t object, const std::string& object_name,
                            const std::string& name, std::string_view text);
  void require(bool written, const std::string& what) const;

  PendingFile pending_;
  Hdf5Kind kind_;
  Hdf5Record record_;
  std::int64_t file_{-1};  // HDF5's handle
};

/// Reads a sealed HDF5 file. Every failure, and every difference between what is requested and what
/// is there, throws Error with the file's name; nothing is converted.
class Hdf5Reader {
 public:
  /// Checks the seal: throws when the file is no such file, is damaged or cut short, is of another
  /// kind, or has a version above `kind.version`.
  Hdf5Reader(const std::filesystem::path& path, const Hdf5Kind& kind);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  [[nodiscard]] std::uint32_t version() const { return version_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool has(const std::string& name) const;
  /// Throws Error also when they are more than the file can hold.
  [[nodiscard]] Hdf5Extents extents(const std::string& name) const;

  /// A whole dataset, which must have these extents.
  template <Hdf5Storable Number>
  [[nodiscard]] std::vector<Number> read(const std::string& name,
                                         const Hdf5Extents& expected) const {
    std::vector<Number> values(check_extents(name, expected));
    read_raw(name, 0, hdf5_number<Number>(), values.data(), values.size());
    return values;
  }
  /// Whole rows from row `first` on, as many as `values` has room for.
  template <Hdf5Storable Number>
  void read_rows(const std::string& name, std::uint64_t first, std::span<Number> values) const {
    read_raw(name, first, hdf5_number<Number>(), values.data(), values.size());
  }
  /// Where the numbers of a dataset lie in the file [bytes], as they are in memory, for those who
  /// read parts of it by themselves. It must have `count` of them.
  template <Hdf5Storable Number>
  [[nodiscard]] std::uint64_t place(const std::string& name, std::uint64_t count) const {
    return place_of(name, hdf5_number<Number>(), count, sizeof(Number));
  }
  [[nodiscard]] std::vector<std::string> read_texts(const std::string& name,
                                                    std::uint64_t count) const;
  [[nodiscard]] std::string read_note(const std::string& name) const;

 private:
  /// The product of the extents, after comparing them with the dataset's.
  [[nodiscard]] std::size_t check_extents(const std::string& name,
                                          const Hdf5Extents& expected) const;
  void read_raw(const std::string& name, std::uint64_t first, Hdf5Number type, void* values,
                std::uint64_t count) const;
  [[nodiscard]] std::uint64_t place_of(const std::string& name, Hdf5Number type,
                                       std::uint64_t count, std::size_t number_size) const;

  std::filesystem::path path_;
  std::uint64_t file_size_{0};
  std::uint32_t version_{0};
  std::int64_t file_{-1};
};

}  // namespace reckon
