// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "reckon/contact/contact_settings.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon {

/// A half space; grains are kept on the side that the normal points to.
struct PlaneSurface {
  Vec3 point;  ///< [m]
  Vec3 normal_unit;

  [[nodiscard]] double distance(const Vec3& p) const { return dot(p - point, normal_unit); }
  [[nodiscard]] Vec3 gradient(const Vec3& /*p*/) const { return normal_unit; }
};

/// The inside of an infinite cylinder.
struct CylinderSurface {
  Vec3 point;  ///< on the axis [m]
  Vec3 axis_unit;
  double radius{0};  ///< [m]

  [[nodiscard]] double distance(const Vec3& p) const { return radius - norm(radial(p)); }
  [[nodiscard]] Vec3 gradient(const Vec3& p) const { return -normalized(radial(p)); }

 private:
  [[nodiscard]] Vec3 radial(const Vec3& p) const {
    const Vec3 from_axis = p - point;
    return from_axis - dot(from_axis, axis_unit) * axis_unit;
  }
};

/// The outside of a solid quarter of space, a ledge with one straight edge, as half of a shear box
/// has on each side:
///
///          grains          top_unit, normal_unit point out of the two faces, at right angles;
///   ______________         the faces meet in the edge
///   solid        | grains
struct LedgeSurface {
  Vec3 point;  ///< on the edge [m]
  Vec3 normal_unit;
  Vec3 top_unit;

  /// Exact: to the nearer face inside; to the nearest point of both faces outside [m].
  [[nodiscard]] double distance(const Vec3& p) const {
    const double beside = dot(p - point, normal_unit);
    const double above = dot(p - point, top_unit);
    if (beside > 0 && above > 0) return std::sqrt(beside * beside + above * above);
    return std::max(beside, above);
  }
  [[nodiscard]] Vec3 gradient(const Vec3& p) const {
    const double beside = dot(p - point, normal_unit);
    const double above = dot(p - point, top_unit);
    if (beside > 0 && above > 0) return normalized(beside * normal_unit + above * top_unit);
    return above > beside ? top_unit : normal_unit;
  }
};

/// Signed distance to the wall, positive where grains may be, with gradient length one.
using WallSurface = std::variant<PlaneSurface, CylinderSurface, LedgeSurface>;

/// How a wall moves: by velocity * t plus amplitude * sin(2 pi frequency t), with t counted from
/// `start` and held from `stop` on.
struct WallMotion {
  Vec3 velocity;               ///< [m/s]
  Vec3 amplitude;              ///< [m]
  double frequency{0};         ///< [Hz]
  double start{0};             ///< [s]
  std::optional<double> stop;  ///< [s]

  /// How far the wall has moved at `time` [m].
  [[nodiscard]] Vec3 displacement(double time) const;
};

/// One wall of a scene; boxes are six of them.
struct Wall {
  std::string name;
  WallSurface surface;  ///< where it stands at time zero
  AnyContactLaw law;    ///< with the wall's own stiffness
  double friction{0};
  /// Moments use the node shortened by its depth, r (1 + phi/|r|), as the authors' public code
  /// does, instead of the node itself.
  bool shortened_lever{false};
  std::optional<WallMotion> motion;
};

/// Where a wall is and how fast it moves at one step.
struct WallPose {
  Vec3 displacement;  ///< since time zero [m]
  Vec3 velocity;      ///< over the last step, as grains' velocities are [m/s]
};
[[nodiscard]] WallPose pose_at(const Wall& wall, std::uint64_t step, double time_step);

/// What a control (boundary/wall_control.hpp) has made of one wall so far, on top of its motion.
struct DrivenWall {
  Vec3 displacement;                 ///< since time zero [m]
  Vec3 velocity;                     ///< over the last step [m/s]
  Vec3 displacement_at_stage_start;  ///< [m]

  friend bool operator==(const DrivenWall&, const DrivenWall&) = default;
};
/// All walls at one step. `driven` is one per wall, or empty.
[[nodiscard]] std::vector<WallPose> poses_at(std::span<const Wall> walls,
                                             std::span<const DrivenWall> driven, std::uint64_t step,
                                             double time_step);

}  // namespace reckon
