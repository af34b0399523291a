// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/analysis/sample.hpp"
#include "reckon/simulation/config.hpp"

namespace reckon {

/// Whether all that the goal of the stage under way asks for holds. The measurements are those of
/// the current step. Collective; the same on all ranks.
[[nodiscard]] bool reached(const StageGoal& goal, const Simulation& simulation,
                           const Measurement& measurement, const SampleMeasurement& sample);

}  // namespace reckon
