// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace reckon {

/// The 64-bit xxHash (XXH64, Collet), fed piece by piece. It detects damage, at the speed of
/// memory. It does not protect against deliberate changes.
class XxHash64 {
 public:
  explicit XxHash64(std::uint64_t seed = 0);

  void update(std::span<const std::byte> bytes);
  void update(std::string_view text) { update(std::as_bytes(std::span{text})); }

  /// The hash of everything so far; more may follow.
  [[nodiscard]] std::uint64_t digest() const;

 private:
  std::uint64_t seed_;
  std::array<std::uint64_t, 4> lanes_;
  std::array<std::byte, 32> pending_{};  // the last size_ % 32 bytes
  std::uint64_t size_{0};
};

class OpenFile;

/// Hashes a file from byte `offset` on and returns its whole length.
std::uint64_t hash_file(const OpenFile& file, std::uint64_t offset, XxHash64& hash);

}  // namespace reckon
