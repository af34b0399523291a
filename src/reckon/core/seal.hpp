// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace reckon {

/// A seal is the first 512 bytes of a file, in plain text:
///
///   Sand Reckoner shape library
///   version 1
///   bytes 73482
///   xxh64 44bc2cf5ad770999
///
/// and NUL bytes to fill up. `bytes` is the length of the whole file, `xxh64` the hash of all that
/// follows the seal and of the three lines above it. `head -4` of a sealed file therefore says what
/// it is.
inline constexpr std::size_t seal_size = 512;

/// Writes the seal over the first 512 bytes of a file that is otherwise complete. Throws
/// MachineFailure, or Error when the file cannot be read, with the name `named`.
void write_seal(const std::filesystem::path& path, const std::string& kind, std::uint32_t version,
                const std::filesystem::path& named);

/// Throws Error, which says that the file stays, when `path` is a file with content that is not
/// sealed as `kind`: it is someone else's, and a name given by mistake must not cost it.
void require_replaceable(const std::filesystem::path& path, const std::string& kind);

struct SealContent {
  std::uint32_t version{0};
  std::uint64_t file_size{0};  ///< [bytes]
};

/// Reads the whole file once and compares it with its seal. Throws Error when it is no sealed file,
/// is of another kind, was cut short or has changed since it was sealed.
[[nodiscard]] SealContent check_seal(const std::filesystem::path& path, const std::string& kind);

}  // namespace reckon
