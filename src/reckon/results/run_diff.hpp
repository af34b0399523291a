// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reckon/output/run_folder.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {

/// One value that is not the same in two runs.
struct Difference {
  std::string what;   ///< e.g. "/grain/position" or a column of the history
  std::string where;  ///< e.g. "grain 12, x" or "step 300"
  std::string first;  ///< the value in the first run
  std::string second;
  std::optional<std::uint64_t> ulps;  ///< how many doubles lie between two finite numbers
};

/// The result of a comparison of two runs.
struct RunComparison {
  struct Part {
    std::string name;                      ///< "history", "checkpoint of step 300", "final state"
    std::string compared;                  ///< how much was compared, e.g. "12 rows"
    std::optional<Difference> difference;  ///< the first one, if any
  };
  std::vector<Part> parts;
  [[nodiscard]] bool identical() const;
};

/// Distance of two doubles in steps from one double to the next; nothing when one is not finite.
[[nodiscard]] std::optional<std::uint64_t> ulps_between(double a, double b);

/// The first difference of two states, bit by bit (+0 and -0 differ, equal NaNs do not).
[[nodiscard]] std::optional<Difference> first_difference(const SimulationState& a,
                                                         const SimulationState& b);

/// Compares the histories, all checkpoints that both have, and the latest checkpoints. Throws Error
/// when a file cannot be read.
[[nodiscard]] RunComparison compare_runs(const RunFolder& a, const RunFolder& b);

}  // namespace reckon
