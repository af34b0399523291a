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

bool ListSkins::used_up(const Grains& grains, std::span<const WallPose> poses,
                        const CellMotion* cell_motion) const {
  // Not a number: used up.
  const auto beyond = [](const Listed& listed, const Vec3& place) {
    return !(squared_norm(place - listed.place) < listed.skin * listed.skin);
  };
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    if (beyond(walls_[w], poses[w].displacement)) return true;
  }
  if (cell_motion != nullptr) {
    const double shared = 0.5 * cell_motion->of_pair();
    return parallel_max(grains.size(), 0, [&](std::size_t slot) {
             const Listed& listed = grains_[slot];
             const Vec3 own = grains.position[slot] - cell_motion->carried(listed.place);
             return norm(own) + shared < listed.skin ? 0.0 : 1.0;
           }) > 0;
  }
  return parallel_max(grains.size(), 0, [&](std::size_t slot) {
           return beyond(grains_[slot], grains.position[slot]) ? 1.0 : 0.0;
         }) > 0;
}

}  // namespace reckon
