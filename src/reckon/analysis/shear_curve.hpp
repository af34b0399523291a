// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

namespace reckon {

/// One point of a shear test's curve. Compression is positive.
struct ShearPoint {
  double axial_strain{0};       ///< in the direction of the largest compression, from its start
  double volumetric_strain{0};  ///< likewise
  double friction_angle{0};     ///< mobilised [deg]
};

/// The results of a shear test.
struct ShearSummary {
  double peak_friction_angle{0};  ///< [deg]
  double strain_at_peak{0};
  double dilatancy_angle{0};        ///< at the peak [deg]
  double final_friction_angle{0};   ///< mean over the last fifth of the strain [deg]
  double final_dilatancy_angle{0};  ///< likewise [deg]
  bool still_rising{false};         ///< the peak is the end of the curve
};

/// How much strain a peak is averaged over, so that no single wiggle makes it, and the slope at it.
/// Of a short curve a tenth at most, or the average would hide the peak.
constexpr double peak_window = 0.005;
constexpr double slope_window = 0.02;

/// Reads a curve whose axial strain grows. The friction angle is averaged over `peak_window` before
/// its largest value is taken; the final value counts as one, so no peak is below it. The slope r =
/// d(volumetric)/d(axial) is that of the line of least squares over `slope_window` around the peak,
/// and gives the angle of dilatancy in triaxial compression, sin(psi) = -r / (2 - r) (Schanz and
/// Vermeer 1996). Nothing for fewer than three points or a curve that does not shear.
[[nodiscard]] std::optional<ShearSummary> summarize(std::span<const ShearPoint> curve);

}  // namespace reckon
