// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "reckon/grains/periodic_cell.hpp"

namespace reckon {

/// How far each grain and wall may move before pairs must be listed anew. Two grains are listed
/// when their spheres come within the sum of both budgets, so nobody can meet unlisted before
/// someone used up its own:
///
///   slow  |--o--|      |--o--|      half the skin each
///   fast  |------------o------------|      as far as it goes while a list should live
///
/// One fast grain so lengthens its own list of partners instead of ending everybody's. A budget
/// depends on the velocity alone, which a ghost has too: all ranks agree on it.
struct MotionBudget {
  double least{0};    ///< half the skin [m]
  double most{0};     ///< [m]
  double horizon{0};  ///< how long a list should live [s]
  /// In a periodic cell, motion with the cell costs no budget but what moves two near grains
  /// against each other: the cell's velocity gradient and its centre.
  UpperMat3 gradient{};
  Vec3 center{};

  /// Lists should live for 50 steps, unless that takes more than four skins. `skin` in m.
  static MotionBudget with(double skin, double time_step) {
    constexpr double most_skins = 4;
    constexpr double steps = 50;
    return {.least = 0.5 * skin, .most = 0.5 * most_skins * skin, .horizon = steps * time_step};
  }

  /// [m]
  [[nodiscard]] double of(const Vec3& velocity) const {
    // Not a number: the least; such a run ends anyway.
    return std::min(std::max(least, norm(velocity) * horizon), most);
  }
  /// Of a grain at `position` [m].
  [[nodiscard]] double of(const Vec3& velocity, const Vec3& position) const {
    return of(velocity - gradient * (position - center));
  }
};

}  // namespace reckon
