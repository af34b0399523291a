// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace reckon {

struct LevelSet;

/// How far from the surface a band keeps distances [spacings].
inline constexpr int band_half_width = 2;

/// A level set's values near the surface only, as a level set's vertices ask for them:
///
///   outside:  phi >= w          reads as w = band_half_width spacings
///   near:     -w < phi < w      a count of w / 2^15, in 16 bits
///   deep:     phi <= -w         from a coarse lattice, every 4th vertex, between whose counts it
///                               is interpolated; at most -w
///
/// So contacts as deep as w see what the full grid holds, to 2^-15 w / 2; deeper ones are pushed
/// out by a distance that is right but for the lattice's coarseness; and a point outside knows at
/// least that w lies between it and the grain.
///
/// All of it is one array of 16-bit words, so that it is stored, sent and shared as one:
///
///   rows     for each row of vertices along x (y faster than z), and one more for the end, where
///            its runs and its near values begin: 2 + 2 words, low half first
///   runs     the stretches of a row that are not outside: first vertex, then the vertex after the
///            last, whose top bit tells that it is a deep one
///   lattice  counts of w / 2^15 2^exponent
///   values   counts of the near vertices
class LevelSetBand {
 public:
  using Word = std::uint16_t;
  static constexpr std::uint32_t deep_bit = 0x8000;     ///< of a run's second word
  static constexpr std::int32_t lattice_step = 4;       ///< vertices from point to point
  static constexpr std::int32_t half_counts = 1 << 15;  ///< near counts that make w

  LevelSetBand() = default;
  /// Does not own the words, which must be those of encode_band or have passed check_band.
  LevelSetBand(const std::array<std::int32_t, 3>& dims, double spacing,
               std::span<const Word> words);

  /// phi at a vertex [m].
  [[nodiscard]] float value(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return pair(i, j, k)[0];
  }

  /// phi at the corners of a cell: bit 0 of the place is one step along x, bit 1 y, bit 2 z [m].
  [[nodiscard]] std::array<float, 8> corners(std::int32_t i, std::int32_t j, std::int32_t k) const {
    std::array<float, 8> phi{};
    std::size_t corner = 0;
    for (std::int32_t c = 0; c < 4; ++c) {
      for (const float value : pair(i, j + (c & 1), k + (c >> 1))) phi[corner++] = value;
    }
    return phi;
  }

 private:
  friend bool is_band(const std::array<std::int32_t, 3>& dims, std::span<const Word> words);

  [[nodiscard]] static std::uint32_t pair_of_words(const Word* words) {
    return words[0] | std::uint32_t{words[1]} << 16U;
  }
  /// phi at a vertex and at the next one of its row; the latter need not exist.
  [[nodiscard]] std::array<float, 2> pair(std::int32_t i, std::int32_t j, std::int32_t k) const;
  [[nodiscard]] float deep_value(std::int32_t i, std::int32_t j, std::int32_t k) const;

  std::int32_t rows_per_layer_{0};
  std::int32_t lattice_row_{0};
  std::int32_t lattice_layer_{0};
  float step_{0};           // of a near count [m]
  float deep_step_{0};      // of a 64th of a lattice count [m]
  float outside_value_{0};  // [m]
  const Word* rows_{nullptr};
  const Word* runs_{nullptr};
  const Word* lattice_{nullptr};
  const Word* values_{nullptr};
};

inline float LevelSetBand::deep_value(std::int32_t i, std::int32_t j, std::int32_t k) const {
  const Word* const cell = lattice_ + (i / lattice_step + j / lattice_step * lattice_row_ +
                                       k / lattice_step * lattice_layer_);
  const auto along_x = [&, part = i % lattice_step](std::int32_t place) {
    const auto low = static_cast<std::int16_t>(cell[place]);
    const auto high = static_cast<std::int16_t>(cell[place + 1]);
    return low * (lattice_step - part) + high * part;
  };
  const auto along_y = [&, part = j % lattice_step](std::int32_t place) {
    return along_x(place) * (lattice_step - part) + along_x(place + lattice_row_) * part;
  };
  const std::int32_t part = k % lattice_step;
  const std::int32_t count = along_y(0) * (lattice_step - part) + along_y(lattice_layer_) * part;
  return std::min(static_cast<float>(count) * deep_step_, -outside_value_);
}

inline std::array<float, 2> LevelSetBand::pair(std::int32_t i, std::int32_t j,
                                               std::int32_t k) const {
  const Word* const row = rows_ + 4 * (std::ptrdiff_t{j} + std::ptrdiff_t{k} * rows_per_layer_);
  std::uint32_t near = pair_of_words(row + 2);
  std::array<float, 2> phi{outside_value_, outside_value_};
  const Word* const end = runs_ + 2 * std::size_t{pair_of_words(row + 4)};
  for (const Word* run = runs_ + 2 * std::size_t{pair_of_words(row)}; run != end; run += 2) {
    const std::int32_t first = run[0];
    const bool deep = (run[1] & deep_bit) != 0;
    const auto last = static_cast<std::int32_t>(run[1] & ~deep_bit);
    if (first > i + 1) break;
    for (std::int32_t v = std::max(i, first); v < std::min(i + 2, last); ++v) {
      const auto count = static_cast<std::uint32_t>(v - first);
      phi[static_cast<std::size_t>(v - i)] =
          deep ? deep_value(v, j, k)
               : static_cast<float>(static_cast<std::int16_t>(values_[near + count])) * step_;
    }
    if (last > i + 1) break;
    if (!deep) near += static_cast<std::uint32_t>(last - first);
  }
  return phi;
}

/// The words of a band. Whatever grid decode_band makes of them gives the same words again.
[[nodiscard]] std::vector<LevelSetBand::Word> encode_band(const LevelSet& grid);

/// Whether words are a band of such a grid: nothing in them leads beyond them.
[[nodiscard]] bool is_band(const std::array<std::int32_t, 3>& dims,
                           std::span<const LevelSetBand::Word> words);

/// Fills in the values of a grid whose dims and spacing are set.
void decode_band(std::span<const LevelSetBand::Word> words, LevelSet& grid);

}  // namespace reckon
