// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/shear_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reckon/analysis/stress.hpp"

namespace reckon {
namespace {

struct Range {
  double low;
  double high;
  [[nodiscard]] bool has(double strain) const { return strain >= low && strain <= high; }
};
Range around(double strain, double window) {
  return {strain - 0.5 * window, strain + 0.5 * window};
}

double mean_friction_angle(std::span<const ShearPoint> curve, const Range& range) {
  double sum = 0;
  double count = 0;
  for (const ShearPoint& point : curve) {
    if (!range.has(point.axial_strain)) continue;
    sum += point.friction_angle;
    ++count;
  }
  return sum / count;
}

/// d(volumetric)/d(axial) by least squares; nothing over less than three points.
std::optional<double> slope(std::span<const ShearPoint> curve, const Range& range) {
  double count = 0;
  double mean_axial = 0;
  double mean_volumetric = 0;
  for (const ShearPoint& point : curve) {
    if (!range.has(point.axial_strain)) continue;
    ++count;
    mean_axial += point.axial_strain;
    mean_volumetric += point.volumetric_strain;
  }
  if (count < 3) return std::nullopt;
  mean_axial /= count;
  mean_volumetric /= count;
  double products = 0;
  double squares = 0;
  for (const ShearPoint& point : curve) {
    if (!range.has(point.axial_strain)) continue;
    const double axial = point.axial_strain - mean_axial;
    products += axial * (point.volumetric_strain - mean_volumetric);
    squares += axial * axial;
  }
  if (!(squares > 0)) return std::nullopt;
  return products / squares;
}

double dilatancy_angle(std::span<const ShearPoint> curve, const Range& range) {
  const auto r = slope(curve, range);
  return r ? degrees_of_sine(-*r / (2 - *r)) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::optional<ShearSummary> summarize(std::span<const ShearPoint> curve) {
  if (curve.size() < 3 || !(curve.back().axial_strain > curve.front().axial_strain)) {
    return std::nullopt;
  }
  const double first = curve.front().axial_strain;
  const double last = curve.back().axial_strain;
  const double window = std::min(peak_window, 0.1 * (last - first));
  ShearSummary summary;
  for (const ShearPoint& point : curve) {
    const double mean = mean_friction_angle(curve, around(point.axial_strain, window));
    if (!(mean > summary.peak_friction_angle)) continue;
    summary.peak_friction_angle = mean;
    summary.strain_at_peak = point.axial_strain;
  }
  const Range end{last - 0.2 * (last - first), last};
  summary.final_friction_angle = mean_friction_angle(curve, end);
  if (summary.final_friction_angle > summary.peak_friction_angle) {
    summary.peak_friction_angle = summary.final_friction_angle;
    summary.strain_at_peak = last;
  }
  summary.still_rising = summary.strain_at_peak >= last - window;
  summary.dilatancy_angle = dilatancy_angle(curve, around(summary.strain_at_peak, slope_window));
  summary.final_dilatancy_angle = dilatancy_angle(curve, end);
  return summary;
}

}  // namespace reckon
