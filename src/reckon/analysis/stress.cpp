// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/stress.hpp"

#include <algorithm>
#include <cmath>

#include "reckon/math/portable.hpp"
#include "reckon/math/symmetric_eigen.hpp"

namespace reckon {

Mat3 symmetric_part(const Mat3& m) {
  Mat3 twice = m;
  twice += transpose(m);
  return 0.5 * twice;
}

double degrees_of_sine(double sine) {
  const double target = std::clamp(sine, -1.0, 1.0);
  // Bisection over turns: portable, and exact to the last bits of an angle in degrees.
  double low = -0.25;
  double high = 0.25;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (low + high);
    (portable::cos_sin_of_turns(middle).sin < target ? low : high) = middle;
  }
  return 360 * 0.5 * (low + high);
}

StressInvariants invariants(const Mat3& stress) {
  StressInvariants result;
  result.principal = symmetric_eigen(symmetric_part(stress)).values;
  const auto& [least, middle, most] = result.principal;
  result.mean = trace(stress) / 3;
  result.deviator =
      std::sqrt(0.5 * ((most - middle) * (most - middle) + (middle - least) * (middle - least) +
                       (most - least) * (most - least)));
  if (most + least > 0) result.friction_angle = degrees_of_sine((most - least) / (most + least));
  return result;
}

}  // namespace reckon
