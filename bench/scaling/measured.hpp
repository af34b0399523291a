// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "reckon/domain/decomposition.hpp"
#include "reckon/parallel/communicator.hpp"

namespace reckon::bench {

struct MeasuredRun {
  std::uint32_t grains{592};
  DecompositionKind decomposition{DecompositionKind::balanced};
  std::uint64_t warm_up{100};  ///< steps before the clock starts
  std::uint64_t steps{300};
  int exchange_batches{40};     ///< of the exchange timed alone
  std::filesystem::path cache;  ///< folder in which the packed start is kept
};

/// One line of column names, one line of a run's figures. On the root; empty elsewhere.
[[nodiscard]] std::string measured_columns();

/// Runs densely packed sand of 279 nodes a grain in a closed box, each grain pushed at every step
/// by a random force of ten times its weight on average (paper, section 6.2), and times it.
/// Collective.
[[nodiscard]] std::string measure(const MeasuredRun& run, const Communicator& ranks);

}  // namespace reckon::bench
