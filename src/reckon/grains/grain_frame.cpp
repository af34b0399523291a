// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/grains/grain_frame.hpp"

#include <algorithm>

#include "reckon/parallel/threads.hpp"

namespace reckon {

void update_frames(const Grains& grains, std::span<const ShapeView> shapes, double density,
                   std::vector<GrainFrame>& frames) {
  frames.resize(std::max(frames.size(), grains.size()));
  parallel_for(grains.size(), 64, [&](std::size_t slot) {
    frames[slot] = frame_of(grains.id[slot], shapes[grains.shape[slot].get()],
                            grains.position[slot], grains.orientation[slot], grains.velocity[slot],
                            grains.angular_velocity_body[slot], density);
  });
}

}  // namespace reckon
