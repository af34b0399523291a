// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "reckon/domain/decomposition.hpp"
#include "reckon/parallel/communicator.hpp"
#include "workloads.hpp"

namespace reckon::bench {

struct MeasuredRun {
  std::string workload{"paper-592"};  ///< one of workload_kinds()
  WorkloadRequest request;            ///< its size, and where its packing is kept
  DecompositionKind decomposition{DecompositionKind::balanced};
  std::uint64_t warm_up{100};  ///< steps before the clock starts
  std::uint64_t steps{300};
  int exchange_batches{40};  ///< of the exchange timed alone
};

/// One line of column names, one line of a run's figures. On the root; empty elsewhere.
[[nodiscard]] std::string measured_columns();

/// Runs a workload of `reckon bench` on these ranks and times it. Collective.
[[nodiscard]] std::string measure(const MeasuredRun& run, const Communicator& ranks);

}  // namespace reckon::bench
