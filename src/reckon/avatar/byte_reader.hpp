// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace reckon {

/// Walks through binary data, never past its end, and keeps the position, so that every complaint
/// names file and byte offset. Numbers are assembled byte by byte, independent of the byte order of
/// the machine. Does not own the data.
class ByteReader {
 public:
  enum class Order : std::uint8_t { little_endian, big_endian };

  ByteReader(std::string_view bytes, std::string name, Order order = Order::little_endian,
             std::size_t start = 0);

  [[nodiscard]] std::size_t offset() const { return offset_; }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - offset_; }

  void skip(std::size_t count);
  /// An integer of 1, 2, 4 or 8 bytes.
  [[nodiscard]] std::uint64_t unsigned_integer(std::size_t size);
  [[nodiscard]] std::int64_t signed_integer(std::size_t size);
  /// An IEEE number of 4 or 8 bytes; NaN and infinity pass.
  [[nodiscard]] double real(std::size_t size);
  /// The same, but throws Error naming `what` when it is not finite.
  [[nodiscard]] double finite_real(std::size_t size, std::string_view what);

  /// Throws Error for the current offset.
  [[noreturn]] void fail(std::string problem, std::string reason, std::string fix) const;

 private:
  void require(std::size_t count) const;

  std::string_view bytes_;
  std::string name_;
  Order order_;
  std::size_t offset_;
};

}  // namespace reckon
