// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "reckon/contact/relative_pose.hpp"
#include "reckon/contact/simd_level.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// A grain whose surface is sought, as a filter in single precision sees it. Lengths are in cells
/// of its grid and counted from the grid's first vertex, so that numbers are of moderate size
/// whatever the unit.
struct FilterTarget {
  FilterTarget(const ShapeView& grain, const RelativePose& at, double master_radius, double skin);

  std::array<float, 9> turn{};    ///< by rows: a point is at turn * point_body + shift
  std::array<float, 3> shift{};   ///< [cells]
  std::array<float, 3> center{};  ///< of the bounding sphere [cells]
  float radius{0};                ///< of the bounding sphere [cells]
  std::array<float, 3> high{};    ///< the last vertex [cells]
  std::array<std::int32_t, 3> last_cell{};
  std::int32_t row{0};                ///< vertices along x
  std::int32_t layer{0};              ///< vertices along x times those along y
  const float* values{nullptr};       ///< of the whole grid [m]
  const LevelSetBand* band{nullptr};  ///< or a band of them
  float phi_to_clearance{0};          ///< [cells/m]
  float skin{0};                      ///< points farther from the sphere are not looked up [cells]
  double spacing{0};                  ///< a cell's edge [m]
  double inverse_spacing{0};          ///< [1/m]
  double margin{0};                   ///< more than single precision may be off by [cells]

  /// A lower bound in metres from a filter's answer.
  [[nodiscard]] double in_metres(float cells) const {
    return (static_cast<double>(cells) - margin) * spacing;
  }
};

/// Points of the master's body frame, one array per coordinate [m], each with a sphere around it.
struct FilterPoints {
  const float* x;
  const float* y;
  const float* z;
  const float* radius;  ///< in cells of the target; null: all zero
  std::size_t count;
};

/// Writes lower bounds of the clearance (see Clearance) of each point's sphere to the target
/// [cells]: from the bounding sphere, and from the grid where that says less than the skin.
///
/// All levels do the same operations in the same order at each point and round alike, so that lists
/// and counters are the same with all of them.
using PointFilter = void (*)(const FilterTarget& target, const FilterPoints& points,
                             float* clearance);

/// The filter of a level that simd_levels_here() lists.
[[nodiscard]] PointFilter point_filter(SimdLevel level);

/// That of a level other than scalar; null when it cannot run here.
[[nodiscard]] PointFilter vector_point_filter(SimdLevel level);

}  // namespace reckon
