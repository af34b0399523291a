// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/byte_reader.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "reckon/core/error.hpp"

namespace reckon {

ByteReader::ByteReader(std::string_view bytes, std::string name, Order order, std::size_t start)
    : bytes_{bytes},
      name_{std::move(name)},
      order_{order},
      offset_{std::min(start, bytes.size())} {}

void ByteReader::require(std::size_t count) const {
  if (count <= remaining()) return;
  fail("the file ends too early",
       std::to_string(count) + " more bytes are needed, " + std::to_string(remaining()) +
           " are there",
       "Copy or write the file again.");
}

void ByteReader::skip(std::size_t count) {
  require(count);
  offset_ += count;
}

std::uint64_t ByteReader::unsigned_integer(std::size_t size) {
  require(size);
  std::uint64_t value = 0;
  for (std::size_t n = 0; n < size; ++n) {
    const std::size_t place = order_ == Order::big_endian ? n : size - 1 - n;
    value = value << 8 | static_cast<unsigned char>(bytes_[offset_ + place]);
  }
  offset_ += size;
  return value;
}

std::int64_t ByteReader::signed_integer(std::size_t size) {
  const std::uint64_t raw = unsigned_integer(size);
  const auto unused_bits = static_cast<int>(8 * (8 - size));
  return static_cast<std::int64_t>(raw << unused_bits) >> unused_bits;  // extends the sign
}

double ByteReader::real(std::size_t size) {
  const std::uint64_t raw = unsigned_integer(size);
  if (size == 4) return std::bit_cast<float>(static_cast<std::uint32_t>(raw));
  return std::bit_cast<double>(raw);
}

double ByteReader::finite_real(std::size_t size, std::string_view what) {
  const std::size_t start = offset_;
  const double value = real(size);
  if (!std::isfinite(value)) {
    offset_ = start;
    fail("the " + std::string{what} + " is not finite", std::to_string(value),
         "Check what wrote the file.");
  }
  return value;
}

void ByteReader::fail(std::string problem, std::string reason, std::string fix) const {
  throw Error{{.place = name_ + ", byte " + std::to_string(offset_),
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = std::move(fix)}};
}

}  // namespace reckon
