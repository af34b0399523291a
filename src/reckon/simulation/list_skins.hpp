// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reckon/boundary/wall.hpp"
#include "reckon/grains/grains.hpp"
#include "reckon/neighbor/adaptive_skin.hpp"
#include "reckon/simulation/cell_drive.hpp"

namespace reckon {

/// Where the owned grains and the walls were when lists were made, and the skin of each: how far it
/// may move before lists must be made again.
class ListSkins {
 public:
  ListSkins(double skin, double time_step) : skin_{AdaptiveSkin::with(skin, time_step)} {}

  /// With the motion of the periodic cell now, which uses no skin.
  void follow_cell(const PeriodicCell& cell) {
    skin_.gradient = cell.gradient();
    skin_.center = cell.center();
  }
  [[nodiscard]] const AdaptiveSkin& skin() const { return skin_; }
  /// The largest of these grains, for lists that are about to be made [m].
  [[nodiscard]] double max_of(const Grains& grains) const;

  /// Lists are made now.
  void record(const Grains& grains, std::span<const WallPose> poses);
  /// Whether some wall has moved through its skin.
  [[nodiscard]] bool used_up_by_walls(std::span<const WallPose> poses) const;
  /// Whether the grain has moved through its skin. `cell_motion`: since record(), in a periodic
  /// cell.
  [[nodiscard]] bool used_up_by(std::size_t slot, const Vec3& position,
                                const CellMotion* cell_motion) const {
    const Listed& listed = grains_[slot];
    // Not a number: used up.
    if (cell_motion == nullptr) return !is_within(listed, position);
    const double own = norm(position - cell_motion->carried(listed.place));
    return !(own + 0.5 * cell_motion->of_pair() < listed.skin);
  }

 private:
  struct Listed {
    Vec3 place;      // of a grain, or the displacement of a wall [m]
    double skin{0};  // [m]
  };
  [[nodiscard]] static bool is_within(const Listed& listed, const Vec3& place) {
    return squared_norm(place - listed.place) < listed.skin * listed.skin;
  }

  AdaptiveSkin skin_;
  std::vector<Listed> grains_;
  std::vector<Listed> walls_;
};

}  // namespace reckon
