// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "reckon/core/id.hpp"
#include "reckon/domain/ghost_exchange.hpp"
#include "reckon/math/vec3.hpp"
#include "reckon/parallel/communicator.hpp"

namespace reckon {

enum class DecompositionKind {
  balanced,   ///< recursive bisection weighted by cost: even work for any arrangement
  grid,       ///< the paper's equal blocks with padding bins and three-phase exchange
  bins,       ///< `grid`, with pairs found by walking over all bins (paper's naive algorithm)
  replicated  ///< every rank holds every grain and tests every pair (the original LS-DEM)
};

/// The owner of each grain, and the ghosts of each rank. Results never depend on it.
class Decomposition {
 public:
  virtual ~Decomposition() = default;

  /// Collective, when lists are rebuilt: computes the regions again where grains have left them.
  /// `positions` and `costs` are those of the owned grains; `reach` is the largest distance of two
  /// centres that may touch before the next lists [m]. Space repeats itself along axes where
  /// `period` is above zero; positions are then between zero and that [m].
  virtual void update(std::span<const Vec3> positions, std::span<const double> costs, double reach,
                      const Vec3& period) = 0;
  [[nodiscard]] virtual int owner_of(GrainId id, const Vec3& position) const = 0;

  /// Collective, after every grain has gone to its owner.
  [[nodiscard]] virtual std::unique_ptr<Ghosts> exchange_ghosts(
      std::vector<BorderGrain> owned) const = 0;
};

/// `grain_count` bounds the grains' ids; only `replicated` uses it.
[[nodiscard]] std::unique_ptr<Decomposition> make_decomposition(DecompositionKind kind,
                                                                const Communicator& ranks,
                                                                std::size_t grain_count);

}  // namespace reckon
