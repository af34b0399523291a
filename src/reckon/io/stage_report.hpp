// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "reckon/analysis/sample.hpp"
#include "reckon/io/history.hpp"
#include "reckon/simulation/config.hpp"

namespace reckon {

/// How a stage ended, in one line. `in_time`: its goal was met, or it had none.
[[nodiscard]] std::string stage_note(const std::string& name, std::uint64_t steps, bool in_time,
                                     const Measurement& measurement,
                                     const SampleMeasurement& sample);

/// Above this a stage counts as too fast for a quasi-static test (da Cruz et al. 2005).
constexpr double quasi_static_inertial_number = 1e-3;

/// What the stages that drive walls by strain rate or speed have shown, a paragraph each: peak
/// friction angle and dilatancy, how well stress by contacts and by walls agree, and whether it was
/// quasi-static. Empty without such stages, and where the history has no columns of the sample.
[[nodiscard]] std::string stage_report(const SceneConfig& scene, const HistoryTable& history);

}  // namespace reckon
