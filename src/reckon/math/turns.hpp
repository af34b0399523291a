// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace reckon {

/// sin(2 pi turns), from additions and multiplications alone, so that it gives the same bits on
/// every machine (the C library's sine does not promise that). Error below 4e-16.
[[nodiscard]] inline double sine_of_turns(double turns) {
  double u = turns - std::floor(turns + 0.5);  // [-1/2, 1/2)
  if (u > 0.25) u = 0.5 - u;                   // fold onto [-1/4, 1/4]
  if (u < -0.25) u = -0.5 - u;
  const double x = 6.283185307179586 * u;
  const double s = x * x;
  double term_sum = 0;
  // Taylor's series by Horner's rule: 1 - s/(2*3) (1 - s/(4*5) (1 - ...)).
  for (int k = 11; k >= 1; --k) {
    term_sum = s / static_cast<double>(2 * k * (2 * k + 1)) * (1 - term_sum);
  }
  return x * (1 - term_sum);
}

}  // namespace reckon
