// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "reckon/grains/periodic_cell.hpp"

namespace reckon {

/// How far each grain and wall may move before pairs must be listed again. Two grains are listed
/// when their spheres come within the sum of both budgets, so no unlisted pair can touch before one
/// of its grains has used its budget:
///
///   slow  |--o--|      |--o--|      half the skin each
///   fast  |------------o------------|      its travel in the planned life of a list
///
/// A fast grain thus lengthens only its own list of partners; the lists of other grains stay valid.
/// A budget depends only on the velocity, which a ghost has too, so all ranks compute the same.
struct MotionBudget {
  double least{0};    ///< half the skin [m]
  double most{0};     ///< [m]
  double horizon{0};  ///< planned life of a list [s]
  /// In a periodic cell, motion with the cell uses no budget, except for the relative motion of two
  /// near grains: the cell's velocity gradient and its centre.
  UpperMat3 gradient{};
  Vec3 center{};

  /// The planned life of a list is 50 steps, unless that needs more than four skins. `skin` in m.
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
