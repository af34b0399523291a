// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/motion/integrator.hpp"

namespace reckon {
namespace {

constexpr int most_corrector_rounds = 20;
constexpr double settled = 1e-15;  // relative to the angular velocity

}  // namespace

Kick kick(const Kick& before, const Mat3& rotation, const Load& load, const Inertia& inertia,
          double damping, double time_step) {
  Kick result;
  const double half_damping = 0.5 * damping * time_step;
  result.velocity =
      ((1 - half_damping) * before.velocity + (time_step / inertia.mass) * load.force) /
      (1 + half_damping);

  const Vec3 moment = transposed_times(rotation, load.moment);  // body frame
  const Vec3& i = inertia.moments;
  const Vec3& omega = before.angular_velocity_body;
  Vec3 increment = before.angular_increment_body;
  for (int round = 0; round < most_corrector_rounds; ++round) {
    const Vec3 middle = omega + 0.5 * increment;
    const Vec3 next{
        time_step * (moment.x + middle.y * middle.z * (i.y - i.z) - damping * i.x * middle.x) / i.x,
        time_step * (moment.y + middle.z * middle.x * (i.z - i.x) - damping * i.y * middle.y) / i.y,
        time_step * (moment.z + middle.x * middle.y * (i.x - i.y) - damping * i.z * middle.z) /
            i.z};
    const double change = squared_norm(next - increment);
    increment = next;
    if (change <= settled * settled * squared_norm(middle)) break;
  }
  result.angular_velocity_body = omega + increment;
  result.angular_increment_body = increment;
  return result;
}

void drift(Grains& grains, std::size_t slot, const Kick& kick, double time_step) {
  grains.velocity[slot] = kick.velocity;
  grains.angular_velocity_body[slot] = kick.angular_velocity_body;
  grains.angular_increment_body[slot] = kick.angular_increment_body;
  grains.position[slot] += time_step * kick.velocity;
  const Vec3 u = (0.25 * time_step) * kick.angular_velocity_body;
  const Quaternion turn{1 - squared_norm(u), 2 * u.x, 2 * u.y, 2 * u.z};
  grains.orientation[slot] = normalized(grains.orientation[slot] * turn);
}

}  // namespace reckon
