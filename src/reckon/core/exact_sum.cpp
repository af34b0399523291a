// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/core/exact_sum.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace reckon {
namespace {

constexpr int digit_bits = 32;
constexpr std::int64_t digit_mask = (std::int64_t{1} << digit_bits) - 1;
constexpr int lowest_exponent = -1074;  // weight of bit 0 of digit 0
constexpr std::uint32_t carry_interval = 1U << 29;
// The last digit is reserved as a flag: it counts values that were not finite.
constexpr int flag_digit = ExactSum::digit_count - 1;

}  // namespace

void ExactSum::add(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto biased_exponent = static_cast<int>((bits >> 52) & 0x7FF);
  if (biased_exponent == 0x7FF) {
    ++digits_[flag_digit];
    return;
  }
  std::uint64_t mantissa = bits & ((std::uint64_t{1} << 52) - 1);
  if (biased_exponent != 0) mantissa |= std::uint64_t{1} << 52;
  // value = +-mantissa * 2^(shift + lowest_exponent)
  const int shift = biased_exponent == 0 ? 0 : biased_exponent - 1;
  const auto first = static_cast<std::size_t>(shift / digit_bits);
  const int offset = shift % digit_bits;
  const std::uint64_t low = mantissa << offset;
  const std::uint64_t high = offset == 0 ? 0 : mantissa >> (64 - offset);
  const auto sign = static_cast<std::int64_t>(bits >> 63);
  const auto signed_digit = [sign](std::uint64_t digit) {
    return (static_cast<std::int64_t>(digit) ^ -sign) + sign;
  };
  digits_[first] += signed_digit(low & static_cast<std::uint64_t>(digit_mask));
  digits_[first + 1] += signed_digit(low >> digit_bits);
  digits_[first + 2] += signed_digit(high);
  if (++pending_ >= carry_interval) carry();
}

void ExactSum::add(const ExactSum& other) {
  ExactSum carried = other;
  carried.carry();
  carry();
  for (std::size_t k = 0; k < digits_.size(); ++k) digits_[k] += carried.digits_[k];
  ++pending_;
}

void ExactSum::carry() {
  for (std::size_t k = 0; k + 1 < flag_digit; ++k) {
    digits_[k + 1] += digits_[k] >> digit_bits;  // arithmetic shift: floor, also below zero
    digits_[k] &= digit_mask;
  }
  pending_ = 0;
}

double ExactSum::value() const {
  ExactSum carried = *this;
  carried.carry();
  auto& digit = carried.digits_;
  if (digit[flag_digit] != 0) return std::numeric_limits<double>::quiet_NaN();
  const bool negative = digit[flag_digit - 1] < 0;
  if (negative) {
    for (int k = 0; k < flag_digit; ++k) digit[static_cast<std::size_t>(k)] *= -1;
    carried.carry();
  }
  int top = flag_digit - 1;
  while (top > 0 && digit[static_cast<std::size_t>(top)] == 0) --top;
  // Round once: gather the leading 64 bits, and fold everything below into a sticky bit.
  std::uint64_t leading = 0;
  int weight = 0;  // exponent of the leading word's bit 0
  const auto at = [&](int k) -> std::uint64_t {
    return k < 0 ? 0 : static_cast<std::uint64_t>(digit[static_cast<std::size_t>(k)]);
  };
  const auto lead_bits = static_cast<int>(std::bit_width(at(top)));
  if (lead_bits == 0) return 0.0;
  leading = (at(top) << (64 - lead_bits)) |
            (lead_bits < 32 ? at(top - 1) << (32 - lead_bits) : at(top - 1) >> (lead_bits - 32));
  if (lead_bits < 32) leading |= at(top - 2) >> lead_bits;
  weight = top * digit_bits + lead_bits - 64 + lowest_exponent;
  bool sticky = false;
  if (lead_bits < 32) {
    sticky = (at(top - 2) & ((std::uint64_t{1} << lead_bits) - 1)) != 0;
  } else {
    sticky = (at(top - 1) & ((std::uint64_t{1} << (lead_bits - 32)) - 1)) != 0 || at(top - 2) != 0;
  }
  for (int k = top - 3; k >= 0 && !sticky; --k) sticky = at(k) != 0;
  leading |= static_cast<std::uint64_t>(sticky);
  // Below 2^-1022 a double has fewer bits; ldexp would round a second time, so cut there first.
  const int spare = lowest_exponent - weight;
  if (spare > 11) {
    if (spare >= 64) return negative ? -0.0 : 0.0;
    const std::uint64_t half = std::uint64_t{1} << (spare - 1);
    const std::uint64_t rest = leading & ((half << 1) - 1);
    leading >>= spare;
    if (rest > half || (rest == half && (leading & 1) != 0)) ++leading;
    weight = lowest_exponent;
  }
  const double magnitude = std::ldexp(static_cast<double>(leading), weight);
  return negative ? -magnitude : magnitude;
}

double exact_sum(std::span<const double> values) {
  ExactSum sum;
  for (const double value : values) sum.add(value);
  return sum.value();
}

}  // namespace reckon
