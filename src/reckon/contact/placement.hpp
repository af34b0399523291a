// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/grains/grain_frame.hpp"

namespace reckon {

/// How a master lies in its slave's body frame: a node of the master is at turn * node + shift.
/// Every finder must compute it by these very expressions: the bits of phi depend on them.
struct Placement {
  Vec3 offset_world;  ///< the master's centre from the slave's [m]
  Mat3 turn;
  Vec3 shift;  ///< [m]
};

[[nodiscard]] inline Placement place(const GrainFrame& master, const GrainFrame& slave) {
  Placement at;
  at.offset_world = master.position - slave.position;
  const Mat3 to_slave = transpose(slave.rotation);
  at.turn = to_slave * master.rotation;
  at.shift = to_slave * at.offset_world;
  return at;
}

/// Whether the bounding spheres meet: if not, nothing touches.
[[nodiscard]] inline bool spheres_meet(const Vec3& offset_world, const ShapeView& master,
                                       const ShapeView& slave) {
  const double reach = master.bounding_radius + slave.bounding_radius;
  return squared_norm(offset_world) < reach * reach;
}

}  // namespace reckon
