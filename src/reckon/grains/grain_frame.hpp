// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reckon/grains/grains.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// One grain as the contact kernels see it at the current step: what a ghost needs too.
struct GrainFrame {
  GrainId id;
  const ShapeView* shape{nullptr};
  Vec3 position;                ///< [m]
  Mat3 rotation;                ///< body to world
  Vec3 velocity;                ///< [m/s]
  Vec3 angular_velocity_world;  ///< [rad/s]
  double mass{0};               ///< [kg]
};

/// Fills `frames[slot]` for every grain; `shapes[id]` are the library's shapes.
void update_frames(const Grains& grains, std::span<const ShapeView> shapes, double density,
                   std::vector<GrainFrame>& frames);

}  // namespace reckon
