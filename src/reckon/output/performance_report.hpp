// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "reckon/simulation/performance.hpp"

namespace reckon {

/// What performance.json is made from.
struct PerformanceOfRun {
  std::span<const RankPerformance> ranks;
  std::uint64_t grains{0};
  double wall_seconds{0};        ///< of the session
  double output_seconds{0};      ///< of these, in which steps waited for files
  double background_seconds{0};  ///< in which files were written while steps went on
};

/// performance.json: counters and time per phase, for the whole session and for every rank.
/// docs/reference/run-folder.md lists the keys.
[[nodiscard]] std::string performance_json(const PerformanceOfRun& run);

/// The same for people: a row per phase (mean and largest over ranks), then the counters. Phases
/// are those of Tan and Sitar (2024), Fig. 14 and Table 2: force, border, migrate, update; and
/// output.
[[nodiscard]] std::string performance_table(const PerformanceOfRun& run);

}  // namespace reckon
