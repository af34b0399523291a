// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/grains/grain_frame.hpp"

#include "reckon/parallel/threads.hpp"

namespace reckon {

void update_frames(const Grains& grains, std::span<const ShapeView> shapes, double density,
                   std::vector<GrainFrame>& frames) {
  frames.resize(grains.size());
  parallel_for(grains.size(), 64, [&](std::size_t slot) {
    const ShapeView& shape = shapes[grains.shape[slot].get()];
    const Mat3 rotation = rotation_matrix(grains.orientation[slot]);
    frames[slot] = {grains.id[slot],
                    &shape,
                    grains.position[slot],
                    rotation,
                    grains.velocity[slot],
                    rotation * grains.angular_velocity_body[slot],
                    density * shape.mass.volume};
  });
}

}  // namespace reckon
