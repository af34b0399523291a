// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace reckon {

/// A file that appears under its own name only when it is complete. Until then its content is in a
/// temporary file in the same folder. After a crash or a full disk, or for an early reader, the
/// final name never refers to an incomplete file.
class PendingFile {
 public:
  /// Creates nothing yet. Throws Error when the target's folder does not exist.
  explicit PendingFile(std::filesystem::path target);
  /// Removes the temporary file unless commit() was called.
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write.
  [[nodiscard]] const std::filesystem::path& temporary() const { return temporary_; }
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }

  /// Flushes the temporary file to disk, gives it the target's name, replacing what was there, and
  /// flushes the folder. Throws MachineFailure when the disk refuses.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_{false};
};

/// The name of the file for which a PendingFile made this temporary one (NAME.PROCESS-NUMBER.tmp);
/// nothing for other files.
[[nodiscard]] std::optional<std::string_view> target_of_temporary(std::string_view name);

/// An open file. Each call completes its work or throws: MachineFailure when the disk refuses to
/// write, Error when it refuses to read. It closes itself.
class OpenFile {
 public:
  /// `flags` are those of open(); a file that is made may be read and written by all, as umask
  /// allows. `named` is the name for messages where it is another one.
  OpenFile(std::filesystem::path path, int flags, std::filesystem::path named = {});
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  [[nodiscard]] std::uint64_t size() const;  ///< [bytes]
  /// As many bytes from `offset` on as `bytes` has room for, less at the end of the file.
  [[nodiscard]] std::size_t read(std::uint64_t offset, std::span<char> bytes) const;
  void write(std::uint64_t offset, std::string_view bytes) const;
  /// Returns once all has reached the disk.
  void flush() const;
  /// Throws if the system did not take all data, which the destructor cannot.
  void close();

  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  [[noreturn]] void fail_to_write(int error_number) const;

  std::filesystem::path named_;
  int descriptor_{-1};
};

/// Writes `parts` one after the other as the whole content of `target`, through a PendingFile.
void write_file(const std::filesystem::path& target, std::span<const std::string_view> parts);
void write_file(const std::filesystem::path& target, std::string_view content);

/// Throws Error where writing `target` would replace a file of another kind: one that is not empty
/// and does not have `mark`, as all files of this kind do, among its first thousand bytes. `kind`
/// is for the message: "table of shapes".
void require_own_file(const std::filesystem::path& target, std::string_view mark,
                      std::string_view kind);

/// The whole content of a file or a pipe, as bytes. Throws Error when it cannot be read, and for a
/// device, which may have no end.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace reckon
