// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "reckon/grains/periodic_cell.hpp"

namespace reckon {

/// The skin of each grain and wall: how far it may move before pairs must be listed again. Two
/// grains are listed when their spheres come within the sum of both skins, so no unlisted pair can
/// touch before one of its grains has moved through its skin:
///
///   slow  |--o--|      |--o--|      half the skin of the scene each
///   fast  |------------o------------|      its travel in the planned life of a list
///
/// A fast grain thus lengthens only its own list of partners; the lists of other grains stay valid.
/// A skin depends only on the velocity, which a ghost has too, so all ranks compute the same.
struct AdaptiveSkin {
  double min{0};      ///< half the skin of the scene [m]
  double max{0};      ///< [m]
  double horizon{0};  ///< planned life of a list [s]
  /// In a periodic cell, motion with the cell does not count, except for the relative motion of two
  /// near grains: the cell's velocity gradient and its centre.
  UpperMat3 gradient{};
  Vec3 center{};

  /// The planned life of a list is 50 steps, unless that needs more than four skins. `skin` in m.
  static AdaptiveSkin with(double skin, double time_step) {
    constexpr double max_skins = 4;
    constexpr double steps = 50;
    return {.min = 0.5 * skin, .max = 0.5 * max_skins * skin, .horizon = steps * time_step};
  }

  /// [m]
  [[nodiscard]] double of(const Vec3& velocity) const {
    // Not a number: the minimum; such a run ends anyway.
    return std::min(std::max(min, norm(velocity) * horizon), max);
  }
  /// Of a grain at `position` [m].
  [[nodiscard]] double of(const Vec3& velocity, const Vec3& position) const {
    return of(velocity - gradient * (position - center));
  }
};

}  // namespace reckon
