// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/shape/level_set_band.hpp"

#include <cmath>

#include "reckon/shape/level_set.hpp"

namespace reckon {
namespace {

constexpr std::int32_t half_counts = LevelSetBand::half_counts;
constexpr std::int32_t lattice_step = LevelSetBand::lattice_step;
constexpr std::int32_t most_counts = half_counts - 1;

float step_of(double spacing) {
  return static_cast<float>(band_half_width * spacing / half_counts);
}

/// Of the lattice's counts: so that any depth fits that a grid of these dims can hold.
int exponent_of(const std::array<std::int32_t, 3>& dims) {
  const std::int32_t deepest = *std::max_element(dims.begin(), dims.end());  // [spacings]
  int exponent = 0;
  while (std::int64_t{deepest} * half_counts / band_half_width >> exponent > most_counts) {
    ++exponent;
  }
  return exponent;
}

std::size_t lattice_points(std::int32_t vertices) {
  return static_cast<std::size_t>((vertices - 1) / lattice_step) + 2;
}

std::size_t row_count(const std::array<std::int32_t, 3>& dims) {
  return static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(dims[2]);
}

enum class Zone : std::uint8_t { outside, near, deep };

/// A vertex's count of steps: half_counts outside, at most -half_counts in the deep.
std::int64_t count_of(float phi, float step) {
  const double count = std::nearbyint(double{phi} / double{step});
  return static_cast<std::int64_t>(std::clamp(count, -9e15, static_cast<double>(half_counts)));
}

Zone zone_of(std::int64_t count) {
  if (count >= half_counts) return Zone::outside;
  return count > -half_counts ? Zone::near : Zone::deep;
}

void append(std::vector<LevelSetBand::Word>& words, std::size_t number) {
  words.push_back(static_cast<LevelSetBand::Word>(number & 0xFFFFU));
  words.push_back(static_cast<LevelSetBand::Word>(number >> 16U));
}

}  // namespace

LevelSetBand::LevelSetBand(const std::array<std::int32_t, 3>& dims, double spacing,
                           std::span<const Word> words)
    : rows_per_layer_{dims[1]},
      lattice_row_{static_cast<std::int32_t>(lattice_points(dims[0]))},
      lattice_layer_{lattice_row_ * static_cast<std::int32_t>(lattice_points(dims[1]))},
      step_{step_of(spacing)},
      deep_step_{std::ldexp(step_, exponent_of(dims) - 6)},
      outside_value_{static_cast<float>(half_counts) * step_},
      rows_{words.data()} {
  static_assert(lattice_step * lattice_step * lattice_step == 64, "deep_step_ divides by it");
  runs_ = rows_ + 4 * (row_count(dims) + 1);
  lattice_ = runs_ + 2 * std::size_t{pair_of_words(runs_ - 4)};
  values_ = lattice_ + static_cast<std::size_t>(lattice_layer_) * lattice_points(dims[2]);
}

std::vector<LevelSetBand::Word> encode_band(const LevelSet& grid) {
  using Word = LevelSetBand::Word;
  const float step = step_of(grid.spacing);
  std::vector<Word> rows;
  std::vector<Word> runs;
  std::vector<Word> values;
  const auto begin_row = [&] {
    append(rows, runs.size() / 2);
    append(rows, values.size());
  };
  for (std::int32_t k = 0; k < grid.dims[2]; ++k) {
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      begin_row();
      Zone before = Zone::outside;
      for (std::int32_t i = 0; i < grid.dims[0]; ++i) {
        const std::int64_t count = count_of(grid.values[grid.index(i, j, k)], step);
        const Zone zone = zone_of(count);
        if (zone == Zone::near) values.push_back(static_cast<Word>(count));
        if (zone != before && zone != Zone::outside) {
          runs.push_back(static_cast<Word>(i));
          runs.push_back(0);
        }
        if (zone != Zone::outside) {
          runs.back() = static_cast<Word>(i + 1);
          if (zone == Zone::deep) runs.back() |= LevelSetBand::deep_bit;
        }
        before = zone;
      }
    }
  }
  begin_row();

  // The lattice ends beyond the grid, where it repeats its last points.
  const float lattice_unit = std::ldexp(step, exponent_of(grid.dims));
  std::vector<Word> lattice;
  for (std::size_t k = 0; k < lattice_points(grid.dims[2]); ++k) {
    for (std::size_t j = 0; j < lattice_points(grid.dims[1]); ++j) {
      for (std::size_t i = 0; i < lattice_points(grid.dims[0]); ++i) {
        const auto vertex = [&](std::size_t point, std::size_t axis) {
          const std::int32_t last = (grid.dims[axis] - 1) / lattice_step;
          return std::min(static_cast<std::int32_t>(point), last) * lattice_step;
        };
        const float phi = grid.values[grid.index(vertex(i, 0), vertex(j, 1), vertex(k, 2))];
        const std::int64_t count = count_of(phi, step);
        const Zone zone = zone_of(count);
        // Of what a decoded grid holds there, so that it gives the same lattice.
        const double seen =
            zone == Zone::deep ? double{phi} : double{static_cast<float>(count) * step};
        const double units = std::nearbyint(seen / double{lattice_unit});
        lattice.push_back(static_cast<Word>(static_cast<std::int16_t>(
            std::clamp(units, double{-most_counts}, double{most_counts}))));
      }
    }
  }

  std::vector<Word> words;
  words.reserve(rows.size() + runs.size() + lattice.size() + values.size());
  for (const auto* part : {&rows, &runs, &lattice, &values}) {
    words.insert(words.end(), part->begin(), part->end());
  }
  return words;
}

bool is_band(const std::array<std::int32_t, 3>& dims, std::span<const LevelSetBand::Word> words) {
  using Band = LevelSetBand;
  const std::size_t rows = row_count(dims);
  if (dims[0] > most_counts || words.size() < 4 * (rows + 1)) return false;
  const auto first_run = [&](std::size_t row) { return Band::pair_of_words(&words[4 * row]); };
  const auto first_near = [&](std::size_t row) { return Band::pair_of_words(&words[4 * row + 2]); };
  const std::size_t lattice =
      lattice_points(dims[0]) * lattice_points(dims[1]) * lattice_points(dims[2]);
  if (words.size() !=
      4 * (rows + 1) + 2 * std::size_t{first_run(rows)} + lattice + first_near(rows)) {
    return false;
  }
  const Band::Word* const runs = &words[4 * (rows + 1)];
  std::uint64_t run = 0;
  std::uint64_t near = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    if (first_run(row) != run || first_near(row) != near || first_run(row + 1) < run) return false;
    std::int32_t free = 0;
    for (; run < first_run(row + 1); ++run) {
      if (run >= first_run(rows)) return false;
      const std::int32_t first = runs[2 * run];
      const auto last = static_cast<std::int32_t>(runs[2 * run + 1] & ~Band::deep_bit);
      if (first < free || last <= first || last > dims[0]) return false;
      if ((runs[2 * run + 1] & Band::deep_bit) == 0)
        near += static_cast<std::uint64_t>(last - first);
      free = last;
    }
  }
  return first_run(rows) == run && first_near(rows) == near;
}

void decode_band(std::span<const LevelSetBand::Word> words, LevelSet& grid) {
  const LevelSetBand band{grid.dims, grid.spacing, words};
  grid.values.resize(grid.index(0, 0, grid.dims[2]));
  for (std::int32_t k = 0; k < grid.dims[2]; ++k) {
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      for (std::int32_t i = 0; i < grid.dims[0]; ++i) {
        grid.values[grid.index(i, j, k)] = band.value(i, j, k);
      }
    }
  }
}

}  // namespace reckon
