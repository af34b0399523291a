// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/random_variates.hpp"

#include <cmath>

#include "reckon/math/portable.hpp"

namespace reckon {

double standard_normal(RandomStream& random) {
  const double radius = std::sqrt(-2 * portable::log(1 - random.uniform()));
  return radius * portable::cos_sin_of_turns(random.uniform()).cos;
}

double gamma_variate(RandomStream& random, double shape) {
  if (shape < 1) {
    const double larger = gamma_variate(random, shape + 1);
    return larger * portable::pow(1 - random.uniform(), 1 / shape);
  }
  const double d = shape - 1.0 / 3;
  const double c = 1 / std::sqrt(9 * d);
  for (;;) {
    const double x = standard_normal(random);
    const double root = 1 + c * x;
    if (root <= 0) continue;
    const double v = root * root * root;
    const double u = 1 - random.uniform();
    if (portable::log(u) < 0.5 * x * x + d * (1 - v + portable::log(v))) return d * v;
  }
}

double bounded_variate(RandomStream& random, double mean, double deviation, double low,
                       double high) {
  if (!(deviation > 0)) return mean;
  const double m = (mean - low) / (high - low);
  const double s = deviation / (high - low);
  const double concentration = m * (1 - m) / (s * s) - 1;
  const double a = gamma_variate(random, m * concentration);
  const double b = gamma_variate(random, (1 - m) * concentration);
  const double fraction = a + b > 0 ? a / (a + b) : m;
  return low + (high - low) * fraction;
}

Vec3 random_direction(RandomStream& random) {
  const double z = random.uniform(-1, 1);
  const auto [cosine, sine] = portable::cos_sin_of_turns(random.uniform());
  const double across = std::sqrt(1 - z * z);
  return {across * cosine, across * sine, z};
}

}  // namespace reckon
