// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "assemblies.hpp"
#include "reckon/domain/decomposition.hpp"

namespace reckon::bench {

/// What one rank would hold and send. Everything is counted, nothing timed.
struct RankLoad {
  std::uint64_t grains{0};  ///< owned
  std::uint64_t ghosts{0};
  double work{0};                ///< the costs of its grains: what `balanced` evens out
  std::uint64_t pairs{0};        ///< listed: those with a ghost are on another rank's list too
  std::uint64_t cross_pairs{0};  ///< of which with a ghost
  std::uint64_t bytes{0};        ///< sent in a plain step
  std::uint64_t messages{0};     ///< sent in a plain step
};

/// How an assembly would be shared out over `ranks`, by the functions that real ranks use: cuts,
/// choice of ghosts, pair lists, costs. `kind` is grid or balanced. `balanced` starts, as a run
/// does, with equal costs of all grains, and draws its regions again, as each new listing of a run
/// would, while the costs of the listed pairs say so. Ranks without a block stay empty.
[[nodiscard]] std::vector<RankLoad> share_out(const Assembly& assembly, DecompositionKind kind,
                                              int ranks);

/// Largest values and sums over all ranks.
struct LoadSummary {
  double most_work{0};
  double work_ratio{1};  ///< largest work / mean work
  double speed_up{1};    ///< work of a single rank / largest work of these ranks
  std::uint64_t most_grains{0};
  std::uint64_t most_pairs{0};
  std::uint64_t most_ghosts{0};
  std::uint64_t most_bytes{0};
  std::uint64_t most_messages{0};
  std::uint64_t idle_ranks{0};  ///< without a grain
  double ghosts_per_rank{0};    ///< mean
  std::uint64_t pairs{0};       ///< of the assembly
  double computed_twice{0};     ///< share of these that two ranks compute
};
[[nodiscard]] LoadSummary summarize(const std::vector<RankLoad>& loads);

}  // namespace reckon::bench
