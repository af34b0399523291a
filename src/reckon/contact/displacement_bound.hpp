// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "reckon/grains/grain_frame.hpp"
#include "reckon/math/upper_triangular.hpp"

namespace reckon {

/// An upper bound on ||to - from|| (spectral norm) for two rotation matrices that is_rotation
/// accepts: the difference of two rotations has two equal singular values and a zero one, so the
/// norm is the Frobenius norm over sqrt 2. Rounding is allowed for.
[[nodiscard]] double turn_distance(const Mat3& from, const Mat3& to);

/// Whether the matrix, which rotation_matrix made, stems from a quaternion of unit norm as closely
/// as turn_distance needs. Only the quaternions of an input file may fail.
[[nodiscard]] bool is_rotation(const Mat3& matrix);

/// How a periodic cell has moved since the last look.
struct CellMotion {
  Vec3 center;            ///< [m]
  UpperMat3 deformation;  ///< F: what moves with the cell goes to F (x - centre)
  double farthest{0};     ///< no two grains that may touch are farther apart than this [m]

  /// How far it has moved two near grains against each other, at most [m].
  [[nodiscard]] double of_pair() const {
    return frobenius_norm(deformation + -1.0 * UpperMat3::identity()) * farthest;
  }
  /// Where what was at `before` would be if it had moved with the cell [m].
  [[nodiscard]] Vec3 carried(const Vec3& before) const {
    return center + deformation * (before - center);
  }
};

/// An upper bound on how far each grain has moved: its path length, which only grows. Between two
/// calls of follow(), no point of grain g within its bounding radius moves farther than
/// path_lengths()[g] grows:
///
///   |x' - x| + R ||Q' - Q||        summed over the calls and rounded upward
///
/// So two grains that are known to be `d` apart do not touch before the sum of both path lengths
/// has grown by d. The bound depends on the frames alone, whatever moved the grains.
///
/// In a periodic cell x is that which the cell's own motion F carried along, and half of what F
/// does to two near grains is added to each: a grain far from the centre is no faster than one near
/// it.
class DisplacementBound {
 public:
  /// Adds the motion since the last call. Slots may hold other grains than before: a grain is
  /// followed by its id, and one that was not there starts anew.
  void follow(std::span<const GrainFrame> frames) {
    begin(frames);
    follow(frames, 0, frames.size());
  }
  /// The same in parts, for frames that do not all arrive at once: first begin(), for which only
  /// the ids need to be there, then every slot in one call of follow(frames, first, last).
  void begin(std::span<const GrainFrame> frames, const CellMotion* cell = nullptr);
  void follow(std::span<const GrainFrame> frames, std::size_t first, std::size_t last);

  /// False when some frame's matrix is no rotation: then nothing may be concluded from what was
  /// known before, and nothing learnt now.
  [[nodiscard]] bool trustworthy() const { return trustworthy_; }

  [[nodiscard]] std::span<const double> path_lengths() const { return path_lengths_; }

 private:
  struct Seen {
    GrainId id;
    Vec3 position;
    Mat3 rotation;
  };
  void reorder(std::span<const GrainFrame> frames);
  [[nodiscard]] double motion_of(const GrainFrame& now, const Seen& before) const;

  std::vector<Seen> seen_;            // per slot, at the last call
  std::vector<double> path_lengths_;  // per slot [m]
  bool trustworthy_{true};
  std::optional<CellMotion> cell_;
};

}  // namespace reckon
