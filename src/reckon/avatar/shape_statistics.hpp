// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "reckon/avatar/generator.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// A quantity by which grains are described.
struct ShapeMeasure {
  const char* name;  ///< as a column's name, with its unit
  double (*of)(const Shape&);
};

/// Diameter of the sphere of equal volume, sieve size, length, width, thickness [m]; elongation,
/// flatness, sphericity, convexity, roundness (ShapeDescriptors).
[[nodiscard]] std::span<const ShapeMeasure> shape_measures();

/// How a measure is spread over grains that count alike.
struct MeasureSpread {
  double mean{0};
  double deviation{0};  ///< standard deviation, with n - 1
  double low{0};        ///< least value
  double tenth{0};      ///< percentiles, interpolated between order statistics
  double median{0};
  double ninetieth{0};
  double high{0};  ///< largest value
};
[[nodiscard]] MeasureSpread spread_of(std::vector<double> values);
[[nodiscard]] MeasureSpread spread_of(const ShapeLibrary& library, const ShapeMeasure& measure);

/// Statistics of the generator that a library's grains suggest: sizes, elongation and flatness are
/// the library's own, the rest is left as it stands in `start`. Throws Error for fewer than 3
/// grains.
[[nodiscard]] GrainStatistics statistics_like(const ShapeLibrary& library,
                                              const GrainStatistics& start = {});

/// How much a match may cost.
struct MatchEffort {
  std::uint32_t trial_grains{24};  ///< generated and measured in each round
  std::uint32_t rounds{5};
  double voxels_per_diameter{20};
};

/// The same, and the generator's roundness and roughness are adjusted until the grains that it
/// makes have the library's mean roundness and convexity as measured on finished shapes (both
/// depend on both, so they are corrected in turn). `on_round` gets the means of each trial. Uses
/// all threads; the result does not depend on their number.
[[nodiscard]] GrainStatistics match_statistics(
    const ShapeLibrary& library, std::uint64_t seed, const MatchEffort& effort,
    const std::function<void(double roundness, double convexity)>& on_round = {});

}  // namespace reckon
