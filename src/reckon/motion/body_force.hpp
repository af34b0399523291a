// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "reckon/core/id.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon {

/// Accelerations that act on every grain, independent of contacts.
struct BodyForce {
  Vec3 gravity;                      ///< [m/s^2]
  double random_acceleration{0};     ///< each component uniform in [-a, a) [m/s^2]
  std::uint64_t random_interval{1};  ///< steps between new random accelerations
  std::uint64_t seed{0};
  std::vector<Vec3> own;  ///< by grain id; empty: none [m/s^2]

  /// All of it but gravity. Random parts come from a counter-based generator keyed by (seed, grain,
  /// step), so they do not depend on the place or order of the calls.
  [[nodiscard]] Vec3 acceleration_besides_gravity(GrainId grain, std::uint64_t step) const;
};

}  // namespace reckon
