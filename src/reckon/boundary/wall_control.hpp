// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "reckon/boundary/enclosure.hpp"
#include "reckon/boundary/wall.hpp"
#include "reckon/core/id.hpp"

namespace reckon {

/// What a controlled wall is held to.
enum class WallTarget {
  stress,       ///< the mean normal stress on its planes, compression positive [Pa]
  strain_rate,  ///< -d(ln L)/dt of the space along its normal, compression positive [1/s]
  speed         ///< of each plane into the space [m/s]
};

/// Drives one plane, or two that face each other and move alike, so that the sample stays where it
/// is. Deterministic: it looks at exact sums only.
///
/// A stress is held by a servo. One step on, planes at speed v feel K v dt + C (v - v_last) more,
/// where K and C are the sums of the stiffnesses and of the dashpots of the contacts at them: the
/// grains have not moved yet. The servo takes the speed that closes a share of the gap,
///
///   K v dt + C (v - v_last) = gain (target area - F)       |v| <= rate_limit L
///
/// with F the sum of the normal forces on the planes and L the space's length along the normal, all
/// as of this very step. The sample sees a piston of mass C dt / gain that is pushed with the
/// target force through a dashpot of K dt / gain: it takes energy out of every wave, and is stable
/// for a gain below one, whatever lies behind. Where nothing touches, planes move at the limit.
struct WallControl {
  std::string name;           ///< as the scene names the planes
  std::vector<WallId> walls;  ///< one or two planes
  WallTarget target{WallTarget::stress};
  double value{0};
  double gain{0.3};      ///< of the servo, in (0, 1)
  double rate_limit{0};  ///< of the servo [1/s]
};

/// What grains do to one wall at one step.
struct WallReaction {
  double normal_force{0};  ///< out of the space, compression positive [N]
  double stiffness{0};     ///< of all contacts, along the normal [N/m]
  double damping{0};       ///< likewise [N s/m]
};

/// The space's length along the planes of a control, the mean distance of its end faces [m].
[[nodiscard]] double length_along(const WallControl& control, const Enclosure& space);
/// The mean normal stress on the planes of a control [Pa].
[[nodiscard]] double stress_on(const WallControl& control, std::span<const WallReaction> reactions,
                               const Enclosure& space);

/// The speed of each plane of the control into the space, `last` being that over the last step
/// [m/s].
[[nodiscard]] double speed_for(const WallControl& control, std::span<const WallReaction> reactions,
                               const Enclosure& space, double last, double time_step);

/// Moves all driven walls from one step to the next; walls without a control stand still.
void advance(std::span<const WallControl> controls, std::span<const Wall> walls,
             std::span<const WallReaction> reactions, const Enclosure& space, double time_step,
             std::span<DrivenWall> driven);

}  // namespace reckon
