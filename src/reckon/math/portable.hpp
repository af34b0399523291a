// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

/// Elementary functions that give the same bits on every machine.
///
/// The C library picks another variant of exp, log, sin, ... for each processor, and their last
/// bits differ. These use only operations that IEEE 754 rounds exactly, in a fixed order. They are
/// good to a few units in the last place and are meant for set-up code, not for inner loops.
namespace reckon::portable {

struct CosSin {
  double cos;
  double sin;
};

/// Cosine and sine of an angle in turns (1 turn = 2 pi), |turns| < 2^50.
[[nodiscard]] inline CosSin cos_sin_of_turns(double turns) {
  const double quarters = std::floor(4 * turns + 0.5);
  const double x = (turns - 0.25 * quarters) * (2 * std::numbers::pi);  // in [-pi/4, pi/4]
  const double xx = x * x;
  double cosine = 1;
  double sine = 1;
  for (int n = 16; n >= 2; n -= 2) {  // Taylor series as nested products
    cosine = 1 - xx / (n * (n - 1)) * cosine;
    sine = 1 - xx / (n * (n + 1)) * sine;
  }
  sine *= x;
  switch (static_cast<std::int64_t>(quarters) & 3) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

/// Natural logarithm of a positive, normal, finite number.
[[nodiscard]] inline double log(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);  // in [1/2, 1)
  if (mantissa < std::numbers::sqrt2 / 2) {
    mantissa *= 2;
    --exponent;
  }
  const double s = (mantissa - 1) / (mantissa + 1);  // log m = 2 artanh s, |s| < 0.172
  const double ss = s * s;
  double series = 0;
  for (int n = 23; n >= 3; n -= 2) series = ss * (series + 1.0 / n);
  return exponent * std::numbers::ln2 + (2 * s + 2 * s * series);
}

/// Exponential function; |x| <= 700.
[[nodiscard]] inline double exp(double x) {
  // ln 2 in two parts: the first has trailing zeros, so that its product with `power` is exact.
  constexpr double ln2_high = 0x1.62e42fefap-1;
  constexpr double ln2_low = 0x1.cf79abc9e3b39p-40;
  const double power = std::floor(x / std::numbers::ln2 + 0.5);
  const double r = (x - power * ln2_high) - power * ln2_low;  // in [-0.35, 0.35]
  double series = 1;
  for (int n = 15; n >= 1; --n) series = 1 + r / n * series;
  return std::ldexp(series, static_cast<int>(power));
}

/// x to the power y for x >= 0 and y > 0.
[[nodiscard]] inline double pow(double x, double y) { return x > 0 ? exp(y * log(x)) : 0; }

/// The cube root of a positive, normal, finite number.
[[nodiscard]] inline double cbrt(double x) {
  const double guess = exp(log(x) / 3);
  return guess - (guess * guess * guess - x) / (3 * guess * guess);  // a Newton step
}

}  // namespace reckon::portable
