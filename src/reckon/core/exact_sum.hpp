// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace reckon {

/// A sum of doubles that does not depend on their order.
///
/// A double is an integer times a power of two. The accumulator is one long fixed-point number
/// that covers the whole range of a double, cut into digits of 32 bits that are kept in 64-bit
/// integers. Adding a value adds its bits to three digits, and integer addition is associative,
/// so any order, and any split over threads or ranks, gives the same digits and the same result.
///
/// Digits hold 2^30 additions before a carry could overflow; `add` carries over long before.
/// Ranks add up `digits()` element by element after `carry()`.
/// An infinity or a NaN makes the result NaN.
class ExactSum {
 public:
  static constexpr int digit_count = 68;  ///< 2^-1074 ... 2^1024 and room for carries
  using Digits = std::array<std::int64_t, digit_count>;

  void add(double value);
  void add(const ExactSum& other);

  /// The sum, rounded once.
  [[nodiscard]] double value() const;

  /// Brings every digit but the last into [0, 2^32), so that sums can be added up safely.
  void carry();
  [[nodiscard]] std::span<std::int64_t> digits() { return digits_; }

 private:
  Digits digits_{};
  std::uint32_t pending_{0};  // additions since the last carry
};

/// The exact sum of `values`, rounded once.
[[nodiscard]] double exact_sum(std::span<const double> values);

}  // namespace reckon
