// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/wall_control.hpp"

#include <algorithm>

namespace reckon {
namespace {

struct Planes {
  double area{0};       // of all planes of a control [m^2]
  double force{0};      // [N]
  double stiffness{0};  // [N/m]
  double damping{0};    // [N s/m]
};

Planes sum_over(const WallControl& control, std::span<const WallReaction> reactions,
                const Enclosure& space) {
  Planes sum;
  for (const WallId wall : control.walls) {
    sum.area += space.areas[wall.get()];
    sum.force += reactions[wall.get()].normal_force;
    sum.stiffness += reactions[wall.get()].stiffness;
    sum.damping += reactions[wall.get()].damping;
  }
  return sum;
}

}  // namespace

double length_along(const WallControl& control, const Enclosure& space) {
  return space.volume / space.areas[control.walls.front().get()];
}

double stress_on(const WallControl& control, std::span<const WallReaction> reactions,
                 const Enclosure& space) {
  const Planes planes = sum_over(control, reactions, space);
  return planes.force / planes.area;
}

double speed_for(const WallControl& control, std::span<const WallReaction> reactions,
                 const Enclosure& space, double last, double time_step) {
  if (control.target == WallTarget::speed) return control.value;
  const double share = length_along(control, space) / static_cast<double>(control.walls.size());
  if (control.target == WallTarget::strain_rate) return control.value * share;
  const Planes planes = sum_over(control, reactions, space);
  const double limit = control.rate_limit * share;
  const double lacking = control.value * planes.area - planes.force;
  if (!(planes.stiffness > 0)) return lacking > 0 ? limit : lacking < 0 ? -limit : 0;
  const double speed = (control.gain * lacking + planes.damping * last) /
                       (planes.stiffness * time_step + planes.damping);
  return std::clamp(speed, -limit, limit);
}

void advance(std::span<const WallControl> controls, std::span<const Wall> walls,
             std::span<const WallReaction> reactions, const Enclosure& space, double time_step,
             std::span<DrivenWall> driven) {
  const auto inward = [&](WallId wall) {
    return std::get<PlaneSurface>(walls[wall.get()].surface).normal_unit;
  };
  std::vector<Vec3> velocities(driven.size());
  for (const WallControl& control : controls) {
    const WallId first = control.walls.front();
    const double last = dot(driven[first.get()].velocity, inward(first));
    const double speed = speed_for(control, reactions, space, last, time_step);
    for (const WallId wall : control.walls) velocities[wall.get()] = speed * inward(wall);
  }
  for (std::size_t w = 0; w < driven.size(); ++w) {
    driven[w].velocity = velocities[w];
    driven[w].displacement += time_step * velocities[w];
  }
}

}  // namespace reckon
