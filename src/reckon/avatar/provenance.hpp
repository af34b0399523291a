// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace reckon {

/// A file that shapes were made from. `xxhsum -H1 FILE` prints the same hash.
struct SourceFile {
  std::string path;        ///< as it was given
  std::uint64_t bytes{0};  ///< length of the file
  std::uint64_t xxh64{0};  ///< XXH64 of its content, seed 0
};

/// How a shape library was made. It has no time and no machine in it, so that the same sources and
/// options still give the same library byte for byte.
struct Provenance {
  std::string program;  ///< name, version and revision; the writer of a file fills it in
  std::vector<std::string> command;  ///< its words, without those that only give the output path
  std::vector<SourceFile> sources;
};

/// Reads and hashes a file, or all files in a folder, in the order of their names. Throws Error
/// when one cannot be read.
[[nodiscard]] std::vector<SourceFile> source_files(const std::filesystem::path& path);
[[nodiscard]] std::vector<SourceFile> source_files(const std::vector<std::string>& paths);

}  // namespace reckon
