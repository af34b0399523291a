// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace reckon {

/// Powers of mass, length, time and angle. An angle is kept apart from a pure number, so that a
/// friction coefficient given as "30 deg" is refused instead of being read as 0.52.
struct Dimension {
  int mass{0};
  int length{0};
  int time{0};
  int angle{0};
  friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};

/// A unit as a multiple of the SI unit of its dimension: factor * 10^exponent.
/// The power of ten is kept apart so that "0.2 mm" becomes the double nearest to 0.0002.
struct Unit {
  Dimension dimension;
  double factor{1};
  int exponent{0};
};

/// A number in SI units with its dimension.
struct Quantity {
  double value{0};
  Dimension dimension;
};

/// Reads a unit such as "kg/m^3", "kN/m", "MPa", "1/s", "m/s²", "N*m". Known are
/// m, g, t, s, min, h, Hz, rad, deg, rev, rpm, N, Pa, bar, J, W, L and %, with the SI prefixes
/// n, u (or µ), m, c, k, M, G before m, g, s, Hz, N, Pa, J, W. An empty text is the pure number.
/// Throws Error with the part that is not understood.
[[nodiscard]] Unit parse_unit(std::string_view text);

/// Reads a number with or without a unit: "0.2 mm", "1e9 N/m^3", "30deg", "0.5".
/// A decimal number in a unit that is a power of ten of its SI unit is rounded once.
/// Throws Error when the text is not a finite number followed by a unit.
[[nodiscard]] Quantity parse_quantity(std::string_view text);

/// "kg m^-1 s^-2" and the like; "1" when all powers are zero.
[[nodiscard]] std::string describe(const Dimension& dimension);

}  // namespace reckon
