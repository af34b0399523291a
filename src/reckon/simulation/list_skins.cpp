// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/list_skins.hpp"

#include "reckon/parallel/threads.hpp"

namespace reckon {

double ListSkins::max_of(const Grains& grains) const {
  return parallel_max(grains.size(), skin_.min, [&](std::size_t slot) {
    return skin_.of(grains.velocity[slot], grains.position[slot]);
  });
}

void ListSkins::record(const Grains& grains, std::span<const WallPose> poses) {
  grains_.clear();
  for (std::size_t slot = 0; slot < grains.size(); ++slot) {
    grains_.push_back(
        {grains.position[slot], skin_.of(grains.velocity[slot], grains.position[slot])});
  }
  walls_.clear();
  for (const WallPose& pose : poses) walls_.push_back({pose.displacement, skin_.of(pose.velocity)});
}

bool ListSkins::used_up_by_walls(std::span<const WallPose> poses) const {
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    if (!is_within(walls_[w], poses[w].displacement)) return true;
  }
  return false;
}

}  // namespace reckon
