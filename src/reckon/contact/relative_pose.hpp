// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/grains/grain_frame.hpp"

namespace reckon {

/// How a master lies in its slave's body frame: a node of the master is at turn * node + shift.
/// Every finder must compute it by these very expressions: the bits of phi depend on them.
struct RelativePose {
  Mat3 turn;
  Vec3 shift;  ///< [m]
};

[[nodiscard]] inline RelativePose relative_pose(const GrainFrame& master, const GrainFrame& slave) {
  RelativePose at;
  const Mat3 to_slave = transpose(slave.rotation);
  at.turn = to_slave * master.rotation;
  at.shift = to_slave * (master.position - slave.position);
  return at;
}

/// Whether the bounding spheres meet: if not, nothing touches. `both_radii` is the master's radius
/// plus the slave's.
[[nodiscard]] inline bool spheres_meet(const Vec3& offset_world, double both_radii) {
  return squared_norm(offset_world) < both_radii * both_radii;
}

}  // namespace reckon
