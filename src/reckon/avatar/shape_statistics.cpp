// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/shape_statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reckon/avatar/shape_sources.hpp"
#include "reckon/core/error.hpp"
#include "reckon/math/portable.hpp"

namespace reckon {
namespace {

constexpr std::array measures{
    ShapeMeasure{"diameter_m", [](const Shape& s) { return s.descriptors.equivalent_diameter; }},
    ShapeMeasure{"sieve_size_m", [](const Shape& s) { return s.descriptors.sieve_size; }},
    ShapeMeasure{"length_m", [](const Shape& s) { return s.descriptors.length; }},
    ShapeMeasure{"width_m", [](const Shape& s) { return s.descriptors.width; }},
    ShapeMeasure{"thickness_m", [](const Shape& s) { return s.descriptors.thickness; }},
    ShapeMeasure{"elongation", [](const Shape& s) { return s.descriptors.elongation; }},
    ShapeMeasure{"flatness", [](const Shape& s) { return s.descriptors.flatness; }},
    ShapeMeasure{"sphericity", [](const Shape& s) { return s.descriptors.sphericity; }},
    ShapeMeasure{"convexity", [](const Shape& s) { return s.descriptors.convexity; }},
    ShapeMeasure{"roundness", [](const Shape& s) { return s.descriptors.roundness; }}};

const ShapeMeasure& measure_named(std::string_view name) {
  return *std::find_if(measures.begin(), measures.end(),
                       [&](const ShapeMeasure& measure) { return measure.name == name; });
}

double percentile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// Kept where a beta distribution with these moments exists, with some room.
Spread bounded_spread(const MeasureSpread& measured, double low, double high) {
  const double room = 1e-3 * (high - low);
  const double mean = std::clamp(measured.mean, low + room, high - room);
  const double most = 0.9 * std::sqrt((mean - low) * (high - mean));
  return {mean, std::min(measured.deviation, most)};
}

}  // namespace

std::span<const ShapeMeasure> shape_measures() { return measures; }

MeasureSpread spread_of(std::vector<double> values) {
  MeasureSpread spread;
  if (values.empty()) return spread;
  std::sort(values.begin(), values.end());
  const auto count = static_cast<double>(values.size());
  for (const double value : values) spread.mean += value / count;
  double squares = 0;
  for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
  spread.deviation = values.size() > 1 ? std::sqrt(squares / (count - 1)) : 0;
  spread.low = values.front();
  spread.tenth = percentile(values, 0.1);
  spread.median = percentile(values, 0.5);
  spread.ninetieth = percentile(values, 0.9);
  spread.high = values.back();
  return spread;
}

MeasureSpread spread_of(const ShapeLibrary& library, const ShapeMeasure& measure) {
  std::vector<double> values;
  values.reserve(library.size());
  for (const Shape& shape : library) values.push_back(measure.of(shape));
  return spread_of(std::move(values));
}

GrainStatistics statistics_like(const ShapeLibrary& library, const GrainStatistics& start) {
  if (library.size() < 3) {
    throw Error{{.place = "library",
                 .problem = fmt::format("{} grains tell no statistics", library.size()),
                 .reason = "at least 3 are needed",
                 .fix = "Name a larger library."}};
  }
  GrainStatistics statistics = start;
  std::vector<double> logarithms;
  for (const Shape& shape : library) {
    logarithms.push_back(portable::log(shape.descriptors.equivalent_diameter));
  }
  const MeasureSpread sizes = spread_of(library, measures.front());
  statistics.median_diameter = sizes.median;
  statistics.log_deviation = std::min(spread_of(logarithms).deviation, 2.0);
  statistics.smallest_diameter = sizes.low;
  statistics.largest_diameter = sizes.high;
  const double least = GrainStatistics::lowest_ratio;
  statistics.elongation = bounded_spread(spread_of(library, measure_named("elongation")), least, 1);
  statistics.flatness = bounded_spread(spread_of(library, measure_named("flatness")), least, 1);
  return statistics;
}

GrainStatistics match_statistics(
    const ShapeLibrary& library, std::uint64_t seed, const MatchEffort& effort,
    const std::function<void(double roundness, double convexity)>& on_round) {
  GrainStatistics statistics = statistics_like(library);
  const MeasureSpread roundness = spread_of(library, measure_named("roundness"));
  const double convexity = spread_of(library, measure_named("convexity")).mean;
  statistics.roundness = bounded_spread(roundness, 0, GrainStatistics::highest_roundness);
  for (std::uint32_t round = 0; round < effort.rounds; ++round) {
    std::vector<ShapeSource> sources;
    for (std::uint32_t n = 0; n < effort.trial_grains; ++n) {
      sources.push_back(generated_source(statistics, seed, n));
    }
    const ShapeLibrary trial = build_library(
        sources, {.voxels_per_diameter = effort.voxels_per_diameter, .node_count = 64});
    const double made_roundness = spread_of(trial, measure_named("roundness")).mean;
    const double made_convexity = spread_of(trial, measure_named("convexity")).mean;
    if (on_round) on_round(made_roundness, made_convexity);
    // Measured roundness goes up about as the generator's does. The share of the hull that is not
    // filled grows about as the relief's height.
    const double top = GrainStatistics::highest_roundness;
    const double mean = std::clamp(statistics.roundness.mean + roundness.mean - made_roundness,
                                   0.02 * top, 0.98 * top);
    statistics.roundness = bounded_spread({mean, roundness.deviation}, 0, top);
    const double factor = (1 - convexity) / std::max(1 - made_convexity, 1e-4);
    statistics.roughness =
        std::clamp(statistics.roughness * std::clamp(factor, 0.5, 2.0), 1e-3, 0.15);
  }
  return statistics;
}

}  // namespace reckon
