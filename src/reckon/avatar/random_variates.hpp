// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/core/random.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon {

// Random numbers of other distributions than the uniform one, the same bits on every machine.

/// Mean 0, variance 1 (Box & Muller 1958).
[[nodiscard]] double standard_normal(RandomStream& random);

/// Gamma distribution of this shape > 0 and scale 1 (Marsaglia & Tsang 2000).
[[nodiscard]] double gamma_variate(RandomStream& random, double shape);

/// A beta distribution on [low, high] with this mean and standard deviation. A deviation of zero
/// gives the mean. Needs low <= mean <= high and deviation^2 < (mean - low) (high - mean).
[[nodiscard]] double bounded_variate(RandomStream& random, double mean, double deviation,
                                     double low, double high);

/// A direction, evenly distributed over the unit sphere.
[[nodiscard]] Vec3 random_direction(RandomStream& random);

}  // namespace reckon
