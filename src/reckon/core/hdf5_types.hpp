// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstdint>
#include <vector>

namespace reckon {

/// The number types that datasets may have.
enum class Hdf5Number : std::uint8_t {
  float32,
  float64,
  int32,
  uint32,
  int64,
  uint64,
  uint8,
  uint16
};

template <class Number>
concept Hdf5Storable = std::same_as<Number, float> || std::same_as<Number, double> ||
    std::same_as<Number, std::int32_t> || std::same_as<Number, std::uint32_t> ||
    std::same_as<Number, std::int64_t> || std::same_as<Number, std::uint64_t> ||
    std::same_as<Number, std::uint8_t> || std::same_as<Number, std::uint16_t>;

template <Hdf5Storable Number>
[[nodiscard]] constexpr Hdf5Number hdf5_number() {
  if constexpr (std::same_as<Number, float>) return Hdf5Number::float32;
  if constexpr (std::same_as<Number, double>) return Hdf5Number::float64;
  if constexpr (std::same_as<Number, std::int32_t>) return Hdf5Number::int32;
  if constexpr (std::same_as<Number, std::uint32_t>) return Hdf5Number::uint32;
  if constexpr (std::same_as<Number, std::int64_t>) return Hdf5Number::int64;
  if constexpr (std::same_as<Number, std::uint64_t>) return Hdf5Number::uint64;
  if constexpr (std::same_as<Number, std::uint16_t>) return Hdf5Number::uint16;
  return Hdf5Number::uint8;
}

/// Lengths of a dataset along each dimension; the first counts "rows".
using Hdf5Extents = std::vector<std::uint64_t>;

}  // namespace reckon
