// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reckon/grains/grains.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// The data of a grain that the contact kernels use at the current step. A ghost has the same.
struct GrainFrame {
  GrainId id;
  const ShapeView* shape{nullptr};
  Vec3 position;                ///< [m]
  Mat3 rotation;                ///< body to world
  Vec3 velocity;                ///< [m/s]
  Vec3 angular_velocity_world;  ///< [rad/s]
  double mass{0};               ///< [kg]
};

/// Prefetches a frame that will be read soon.
inline void prefetch_frame(const GrainFrame& frame) {
  for (std::size_t byte = 0; byte < sizeof frame; byte += 64) {
    __builtin_prefetch(reinterpret_cast<const char*>(&frame) + byte);
  }
}

/// The frame of one grain from its state.
[[nodiscard]] inline GrainFrame frame_of(GrainId id, const ShapeView& shape, const Vec3& position,
                                         const Quaternion& orientation, const Vec3& velocity,
                                         const Vec3& angular_velocity_body, double density) {
  const Mat3 rotation = rotation_matrix(orientation);
  return {id,
          &shape,
          position,
          rotation,
          velocity,
          rotation * angular_velocity_body,
          density * shape.mass.volume};
}

/// Fills `frames[slot]` for every grain and leaves what lies behind; `shapes[id]` are the library's
/// shapes.
void update_frames(const Grains& grains, std::span<const ShapeView> shapes, double density,
                   std::vector<GrainFrame>& frames);

}  // namespace reckon
