// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/grains/grains.hpp"

namespace reckon {

/// A grain's velocities half a step later.
struct Kick {
  Vec3 velocity;                ///< [m/s]
  Vec3 angular_velocity_body;   ///< [rad/s]
  Vec3 angular_increment_body;  ///< [rad/s]
};

/// One grain's inertia.
struct Inertia {
  double mass{0};  ///< [kg]
  Vec3 moments;    ///< principal moments, body frame [kg m^2]
};

/// The current velocities of a grain, with the increment of the last step.
[[nodiscard]] inline Kick velocities_of(const Grains& grains, std::size_t slot) {
  return {grains.velocity[slot], grains.angular_velocity_body[slot],
          grains.angular_increment_body[slot]};
}

/// Velocities at n+1/2 from those at n-1/2 and the load at n.
///
/// Translation is leapfrog with global damping `xi` [1/s] (paper, C.2). Rotation solves Euler's
/// equations in the body frame with the angular velocity at n taken as the mean of both half steps
/// (paper, C.4-C.11): the predictor is last step's increment, and the corrector repeats until the
/// increment no longer changes. `rotation` is that of the grain's orientation at n.
[[nodiscard]] Kick kick(const Kick& before, const Mat3& rotation, const Load& load,
                        const Inertia& inertia, double damping, double time_step);
[[nodiscard]] inline Kick kick(const Grains& grains, std::size_t slot, const Mat3& rotation,
                               const Load& load, const Inertia& inertia, double damping,
                               double time_step) {
  return kick(velocities_of(grains, slot), rotation, load, inertia, damping, time_step);
}

/// Moves a grain from n to n+1 with the velocities at n+1/2. The quaternion takes the implicit
/// midpoint rule (paper, C.12-C.13), whose solution is q (1+u)^2 / (1+u.u) with u = dt/4 omega.
void drift(Grains& grains, std::size_t slot, const Kick& kick, double time_step);

}  // namespace reckon
