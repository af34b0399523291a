// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace reckon {

/// A file that appears under its own name only when it is complete. Until then its content lives
/// in a temporary file in the same folder, so that a crash, a full disk or a reader that comes too
/// early never meets half a file under a good name.
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

  /// Flushes the temporary file to disk and gives it the target's name, replacing what was there.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool committed_{false};
};

/// Writes `parts` one after the other as the whole content of `target`, by way of a PendingFile.
void write_file(const std::filesystem::path& target, std::span<const std::string_view> parts);
void write_file(const std::filesystem::path& target, std::string_view content);

/// The whole content of a file, as bytes. Throws Error when it cannot be read.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

}  // namespace reckon
