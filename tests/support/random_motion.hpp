// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/core/random.hpp"
#include "reckon/grains/grain_frame.hpp"

namespace reckon::testing {

/// Moves one frame about at random, as a grain that may stride and turn at the same time.
class RandomMotion {
 public:
  RandomMotion(RandomStream& random, GrainFrame& frame, const Vec3& start)
      : random_{random}, frame_{frame} {
    frame_.position = start;
    orientation_ = normalized(Quaternion{component(1), component(1), component(1), component(1)});
    frame_.rotation = rotation_matrix(orientation_);
  }

  /// A shift of about `stride` besides `drift`, and a turn that moves the surface about as far.
  void move(double stride, const Vec3& drift) {
    last_shift_ = drift + Vec3{component(stride), component(stride), component(stride)};
    frame_.position += last_shift_;
    const double half = 0.5 * stride / frame_.shape->bounding_radius;
    orientation_ =
        normalized(normalized(Quaternion{1, component(half), component(half), component(half)}) *
                   orientation_);
    frame_.rotation = rotation_matrix(orientation_);
  }

  /// The same shift as another grain's; no turn.
  void follow(const Vec3& shift) { frame_.position += shift; }

  [[nodiscard]] const Vec3& last_shift() const { return last_shift_; }

 private:
  double component(double size) { return random_.uniform(-size, size); }

  RandomStream& random_;
  GrainFrame& frame_;
  Quaternion orientation_;
  Vec3 last_shift_;
};

}  // namespace reckon::testing
