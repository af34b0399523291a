// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/motion/body_force.hpp"

#include "reckon/core/random.hpp"

namespace reckon {

Vec3 BodyForce::acceleration_besides_gravity(GrainId grain, std::uint64_t step) const {
  Vec3 acceleration;
  if (grain.get() < own.size()) acceleration += own[grain.get()];
  if (random_acceleration > 0) {
    RandomStream stream{seed, RandomPurpose::body_force,
                        (step / random_interval) << 32 | grain.get()};
    for (int axis = 0; axis < 3; ++axis) {
      acceleration[axis] += stream.uniform(-random_acceleration, random_acceleration);
    }
  }
  return acceleration;
}

}  // namespace reckon
