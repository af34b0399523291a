// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "reckon/shape/shape.hpp"

namespace reckon {

// What near lists of grains and of walls share.

/// Odometer readings of nodes and pairs that are always looked at, or never again.
inline constexpr double wake_always = -std::numeric_limits<double>::infinity();
inline constexpr double wake_never = std::numeric_limits<double>::infinity();

/// A list is made anew once this share of its allowance is used up.
inline constexpr double list_lifetime = 0.75;

/// The mean distance of neighbouring nodes [m].
[[nodiscard]] inline double node_spacing(const ShapeView& shape) {
  const double count = static_cast<double>(shape.node_x.size()) + 1;
  return shape.bounding_radius * std::sqrt(4 * std::numbers::pi / count);
}

/// Nodes nearer than this many spacings are listed. A wide skin makes long lists that live long: a
/// list starts with a narrow one, which widens when the list had to be made anew before that had
/// paid, and narrows when it lived long. Both are counted, in steps and in points looked at, not
/// timed, so that they are the same in every run.
class SkinTuner {
 public:
  [[nodiscard]] double spacings() const { return spacings_; }

  /// A list was made at `step` by a look at so many nodes and clusters.
  void made(std::uint64_t step, std::uint64_t points) {
    step_ = step;
    points_ = points;
  }
  /// It is about to be made anew.
  void ends(std::uint64_t step) {
    const std::uint64_t life = step - step_;
    if (life < steps_that_pay * points_) spacings_ = std::min(spacings_ * widening, widest);
    if (life > 16 * steps_that_pay * points_) spacings_ = std::max(spacings_ / widening, narrowest);
  }

 private:
  static constexpr std::uint64_t steps_that_pay = 4;  // for each point looked at
  static constexpr double widening = 1.5;
  static constexpr double narrowest = 0.25;
  static constexpr double widest = 1;

  double spacings_{narrowest};
  std::uint64_t step_{0};
  std::uint64_t points_{0};
};

}  // namespace reckon
