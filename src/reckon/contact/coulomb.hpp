// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/math/vec3.hpp"

namespace reckon {

/// One step of the Coulomb spring (paper, B.2-B.5).
struct CoulombSlider {
  Vec3 force;      ///< on the master after the step [N]
  double lost{0};  ///< energy lost to sliding [J]
};

/// Stretches `spring` [N], already in the tangent plane, by the tangential part of
/// `velocity` * `time_step`, then caps it at `limit` [N]. `stiffness` in N/m.
[[nodiscard]] inline CoulombSlider slide(const Vec3& spring, const Vec3& velocity,
                                         const Vec3& normal, double time_step, double stiffness,
                                         double limit) {
  const Vec3 displacement = (velocity - dot(velocity, normal) * normal) * time_step;
  const Vec3 trial = spring - stiffness * displacement;
  const double trial_squared = squared_norm(trial);
  // Without a branch, so that loops over nodes can become vectors.
  const bool sticks = trial_squared <= limit * limit;
  Vec3 capped = (sticks ? 1.0 : limit / std::sqrt(trial_squared)) * trial;
  // Lost: the slip times the mean of the forces before and after, which is what the step took in
  // by the trapezoidal rule less what the spring now holds.
  return {capped, sticks ? 0.0 : dot(spring + capped, trial - capped) / (2 * stiffness)};
}

}  // namespace reckon
