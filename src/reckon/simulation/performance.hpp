// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "reckon/simulation/distribution.hpp"
#include "reckon/simulation/phase_times.hpp"

namespace reckon {

/// What one rank did since the simulation began. Plain numbers, so that ranks can send it.
struct RankPerformance {
  PhaseTimes phases;
  CommunicationCounters communication;
  std::uint64_t steps{0};
  std::uint64_t list_rebuilds{0};
  std::uint64_t grain_steps{0};        ///< steps summed over the owned grains
  std::uint64_t ghost_steps{0};        ///< steps summed over the ghosts
  std::uint64_t pair_steps{0};         ///< steps summed over the listed pairs
  std::uint64_t shared_pair_steps{0};  ///< likewise over pairs that another rank computes too
  double work{0};                      ///< steps summed over the cost by which grains are balanced
  std::uint64_t peak_memory{0};        ///< of this process, shared blocks included [bytes]
  std::uint64_t shape_bytes{0};        ///< shapes at hand, once per machine [bytes]
  std::uint64_t threads{0};
  std::uint64_t rank_on_machine{0};  ///< 0 on one rank of every machine
};

}  // namespace reckon
