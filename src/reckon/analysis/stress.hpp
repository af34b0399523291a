// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/math/rotation.hpp"

namespace reckon {

/// The invariants of a stress used in geotechnics. Compression is positive.
struct StressInvariants {
  double mean{0};            ///< p, a third of the trace [Pa]
  double deviator{0};        ///< q = sqrt(3 J2): sigma_1 - sigma_3 where two are equal [Pa]
  Vec3 principal;            ///< ascending [Pa]
  double friction_angle{0};  ///< mobilised: sin = (sigma_1 - sigma_3) / (sigma_1 + sigma_3) [deg]

  friend bool operator==(const StressInvariants&, const StressInvariants&) = default;
};

/// Of the symmetric part of `stress` [Pa].
[[nodiscard]] StressInvariants invariants(const Mat3& stress);

[[nodiscard]] Mat3 symmetric_part(const Mat3& m);

/// The angle whose sine is `sine`, cut to [-1, 1]; the same bits everywhere [deg].
[[nodiscard]] double degrees_of_sine(double sine);

}  // namespace reckon
