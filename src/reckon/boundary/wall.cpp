// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/wall.hpp"

#include <algorithm>

#include "reckon/math/portable.hpp"

namespace reckon {

Vec3 WallMotion::displacement(double time) const {
  double moving = std::max(time - start, 0.0);
  if (stop) moving = std::min(moving, std::max(*stop - start, 0.0));
  return velocity * moving + amplitude * portable::cos_sin_of_turns(frequency * moving).sin;
}

WallPose pose_at(const Wall& wall, std::uint64_t step, double time_step) {
  if (!wall.motion) return {};
  const Vec3 now = wall.motion->displacement(static_cast<double>(step) * time_step);
  if (step == 0) return {now, {}};
  const Vec3 before = wall.motion->displacement(static_cast<double>(step - 1) * time_step);
  return {now, (now - before) / time_step};
}

std::vector<WallPose> poses_at(std::span<const Wall> walls, std::span<const DrivenWall> driven,
                               std::uint64_t step, double time_step) {
  std::vector<WallPose> poses;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    poses.push_back(pose_at(walls[w], step, time_step));
    if (driven.empty()) continue;
    poses.back().displacement += driven[w].displacement;
    poses.back().velocity += driven[w].velocity;
  }
  return poses;
}

}  // namespace reckon
