// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reckon/domain/decomposition.hpp"

namespace reckon {

/// Every rank holds every grain: the scheme of the original LS-DEM, kept as a plain oracle. Grains
/// are shared out by id, and states are spread by one Allreduce over all of them.
class ReplicatedDecomposition final : public Decomposition {
 public:
  ReplicatedDecomposition(Communicator ranks, std::size_t grain_count)
      : ranks_{std::move(ranks)}, grain_count_{grain_count} {}

  void update(std::span<const Vec3> /*positions*/, std::span<const double> /*costs*/,
              double /*reach*/, const Vec3& /*period*/) override {}
  [[nodiscard]] int owner_of(GrainId id, const Vec3& position) const override;
  [[nodiscard]] std::unique_ptr<Ghosts> exchange_ghosts(
      std::vector<BorderGrain> owned) const override;

 private:
  Communicator ranks_;
  std::size_t grain_count_;
};

}  // namespace reckon
