// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reckon/grains/grain_frame.hpp"

namespace reckon {

/// An upper bound on ||to - from|| (spectral norm) for two rotation matrices that is_rotation
/// accepts: the difference of two rotations has two equal singular values and a zero one, so the
/// norm is the Frobenius norm over sqrt 2. Rounding is allowed for.
[[nodiscard]] double turn_distance(const Mat3& from, const Mat3& to);

/// Whether the matrix, which rotation_matrix made, stems from a quaternion of unit norm as closely
/// as turn_distance needs. Only the quaternions of an input file may fail.
[[nodiscard]] bool is_rotation(const Mat3& matrix);

/// How far each grain has travelled: a bound that only grows. No point of grain g that lies within
/// its bounding radius moves farther between two calls of follow() than travelled()[g] grows:
///
///   |x' - x| + R ||Q' - Q||        summed over the calls and rounded upward
///
/// So two grains that are known to be `d` apart do not touch before the sum of what both have
/// travelled has grown by d. The meter looks at frames alone, whatever moved them.
class MotionMeter {
 public:
  /// Adds the motion since the last call. Slots may hold other grains than before: a grain is
  /// followed by its id, and one that was not there starts anew.
  void follow(std::span<const GrainFrame> frames) {
    begin(frames);
    follow(frames, 0, frames.size());
  }
  /// The same in parts, for frames that do not all arrive at once: first begin(), for which only
  /// the ids need to be there, then every slot in one call of follow(frames, first, last).
  void begin(std::span<const GrainFrame> frames);
  void follow(std::span<const GrainFrame> frames, std::size_t first, std::size_t last);

  /// False when some frame's matrix is no rotation: then nothing may be concluded from what was
  /// known before, and nothing learnt now.
  [[nodiscard]] bool trustworthy() const { return trustworthy_; }

  [[nodiscard]] std::span<const double> travelled() const { return travelled_; }

 private:
  struct Seen {
    GrainId id;
    Vec3 position;
    Mat3 rotation;
  };
  void reorder(std::span<const GrainFrame> frames);

  std::vector<Seen> seen_;         // per slot, at the last call
  std::vector<double> travelled_;  // per slot [m]
  bool trustworthy_{true};
};

}  // namespace reckon
