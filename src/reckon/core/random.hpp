// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

namespace reckon {

/// Counter-based random numbers: Philox4x32-10 (Salmon et al. 2011, "Parallel random numbers: as
/// easy as 1, 2, 3"). The same key and counter give the same four words on every rank, thread and
/// machine, in any order of calls; nothing is stored between calls.
[[nodiscard]] constexpr std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                                            std::array<std::uint32_t, 2> key) {
  constexpr std::uint64_t multiplier_0 = 0xD2511F53;
  constexpr std::uint64_t multiplier_1 = 0xCD9E8D57;
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product_0 = multiplier_0 * counter[0];
    const std::uint64_t product_1 = multiplier_1 * counter[2];
    counter = {static_cast<std::uint32_t>(product_1 >> 32) ^ counter[1] ^ key[0],
               static_cast<std::uint32_t>(product_1),
               static_cast<std::uint32_t>(product_0 >> 32) ^ counter[3] ^ key[1],
               static_cast<std::uint32_t>(product_0)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

/// A double in [0, 1) from two random words: 53 bits, evenly spaced.
[[nodiscard]] constexpr double unit_interval(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (std::uint64_t{high} << 21) ^ (low >> 11);
  return static_cast<double>(bits) * 0x1.0p-53;
}

/// The purpose of a random number. Streams of different purposes never share a number.
enum class RandomPurpose : std::uint32_t {
  body_force = 1,
  placement = 2,
  orientation = 3,
  shape_choice = 4,
  grain_form = 5,
  grain_surface = 6,
  other = 7,
  scan_noise = 8,
};

/// An endless stream of numbers for one (seed, purpose, subject), for sequential use.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, RandomPurpose purpose, std::uint64_t subject)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
        counter_{0, static_cast<std::uint32_t>(subject), static_cast<std::uint32_t>(subject >> 32),
                 static_cast<std::uint32_t>(purpose)} {}

  /// Uniform in [0, 1).
  [[nodiscard]] double uniform() {
    const auto words = philox(counter_, key_);
    ++counter_[0];
    return unit_interval(words[0], words[1]);
  }
  /// Uniform in [low, high).
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
};

}  // namespace reckon
