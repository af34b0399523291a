// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/domain/decomposition.hpp"

#include "reckon/domain/balanced_decomposition.hpp"
#include "reckon/domain/grid_decomposition.hpp"
#include "reckon/domain/replicated_decomposition.hpp"

namespace reckon {

std::unique_ptr<Decomposition> make_decomposition(DecompositionKind kind, const Communicator& ranks,
                                                  std::size_t grain_count) {
  switch (kind) {
    case DecompositionKind::balanced:
      return std::make_unique<BalancedDecomposition>(ranks);
    case DecompositionKind::grid:
    case DecompositionKind::bins:
      return std::make_unique<GridDecomposition>(ranks);
    case DecompositionKind::replicated:
      return std::make_unique<ReplicatedDecomposition>(ranks, grain_count);
  }
  return nullptr;
}

}  // namespace reckon
