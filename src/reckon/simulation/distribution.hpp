// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "reckon/boundary/wall_contacts.hpp"
#include "reckon/contact/grain_contacts.hpp"
#include "reckon/domain/decomposition.hpp"
#include "reckon/grains/grain_frame.hpp"
#include "reckon/grains/periodic_cell.hpp"
#include "reckon/neighbor/adaptive_skin.hpp"

namespace reckon {

/// What communication cost since the run began, on this rank.
struct CommunicationCounters {
  std::uint64_t updates{0};          ///< ghost updates
  std::uint64_t update_bytes{0};     ///< sent in them
  std::uint64_t update_messages{0};  ///< sent in them
  std::uint64_t migrations{0};       ///< rebuilds in which some grain of any rank moved
  std::uint64_t migrated_grains{0};  ///< that left this rank
  std::uint64_t migration_bytes{0};  ///< sent with them
};

/// The grains of one simulation, spread over ranks: brings each to its owner when lists are made
/// anew, and keeps ghosts up to date in between.
class Distribution {
 public:
  /// `grain_count` on all ranks together, `id_count` above all ids.
  Distribution(const Communicator& ranks, DecompositionKind kind, std::size_t grain_count,
               std::size_t id_count);

  [[nodiscard]] const Communicator& ranks() const { return ranks_; }

  /// Collective. Across-block migration: every grain goes to the rank that owns its place, with the
  /// springs of all its contacts; geometry never travels. `costs` are per owned grain; `reach` is
  /// the largest distance of two centres that may touch before the next call [m]. Throws Error on
  /// all ranks when the number of grains, their mass or their momentum is not what it was. The cell
  /// that is given here, if any, stays that of the lists until the next call.
  void redistribute(Grains& grains, GrainContacts& grain_contacts, WallContacts& wall_contacts,
                    std::span<const ShapeView> shapes, std::span<const double> costs, double reach,
                    const PeriodicCell* cell = nullptr);
  /// So many grains have left for good, on all ranks together.
  void expect_fewer(std::size_t count) { grain_count_ -= count; }

  /// Collective. Chooses the ghosts anew from where the owned grains are now.
  void list_ghosts(const Grains& grains);
  /// Sends the owned grains' new states; ghosts() hold theirs after finish_update().
  void start_update(const Grains& grains);
  void finish_update();
  [[nodiscard]] std::span<const BorderGrain> ghosts() const { return ghosts_->ghosts(); }

  /// Pairs of near grains with at least one owned; `frames` holds owned grains, then ghosts. Those
  /// are near whose spheres will not be farther apart than `gap` [m].
  [[nodiscard]] std::vector<Pair> find_pairs(std::span<const GrainFrame> frames,
                                             const AdaptiveSkin& skin, double gap,
                                             std::size_t owned) const;

  [[nodiscard]] const CommunicationCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] std::vector<Bytes> pack_leaving(const Grains& grains, std::span<const int> owners,
                                                const GrainContacts& grain_contacts,
                                                const WallContacts& wall_contacts);

  Communicator ranks_;
  DecompositionKind kind_;
  std::size_t grain_count_;
  std::unique_ptr<Decomposition> decomposition_;
  std::unique_ptr<Ghosts> ghosts_;
  std::optional<PeriodicCell> cell_;
  CommunicationCounters counters_;
};

}  // namespace reckon
