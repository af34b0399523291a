// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "reckon/contact/contact_counters.hpp"
#include "reckon/contact/contact_settings.hpp"
#include "reckon/contact/displacement_bound.hpp"
#include "reckon/contact/near_list.hpp"
#include "reckon/contact/node_lanes.hpp"
#include "reckon/contact/pair_lanes.hpp"
#include "reckon/contact/spring_store.hpp"
#include "reckon/contact/touch.hpp"
#include "reckon/grains/grain_frame.hpp"
#include "reckon/grains/periodic_cell.hpp"
#include "reckon/neighbor/pair_list.hpp"

namespace reckon {

/// What one pair of grains does at the current step.
struct PairForce {
  Vec3 force_on_a;            ///< on the grain of lower id; the other gets the opposite [N]
  Vec3 moment_a;              ///< about a's centre of mass [N m]
  Vec3 moment_b;              ///< about b's centre of mass [N m]
  double deepest{0};          ///< largest penetration of a node [m]
  double elastic{0};          ///< stored [J]
  double friction{0};         ///< lost in this step [J]
  double dashpot{0};          ///< lost in this step [J]
  double fracture{0};         ///< lost in this step, as a bond broke [J]
  float stiffness{0};         ///< see ContactLaw; of a bond, too [N/m]
  float damping{0};           ///< likewise [N s/m]
  std::uint32_t touching{0};  ///< nodes
  bool bonded{false};         ///< and the bond holds, whose force is in the sum

  [[nodiscard]] bool holds() const { return touching > 0 || bonded; }
};

/// The memory of one pair as a checkpoint or a message carries it.
struct PairSprings {
  GrainId id_a;
  GrainId id_b;
  std::vector<NodeSpring> springs;  ///< a's nodes first, each in node order
  std::optional<Bond> bond{};

  friend bool operator==(const PairSprings&, const PairSprings&) = default;
};

/// Bonds that broke since the start, by their end.
struct BrokenBonds {
  std::uint64_t in_tension{0};
  std::uint64_t in_shear{0};

  friend bool operator==(const BrokenBonds&, const BrokenBonds&) = default;
};

/// Contacts between grains: the list of pairs, their springs and their forces.
///
/// A step is evaluate(), then load_on() for every grain, then commit(). Without commit() the
/// springs stay those of the last step, so forces can be looked at without moving on.
///
/// With ContactEngine::near the nodes that touch are kept in PairLanes and computed at every step,
/// eight at a time. Nodes that are near but do not touch are in the near lists of their pair, which
/// are searched only when some of them may have begun to touch:
///
///   path_length (sum of what both grains travelled) >= next_check_[pair]
///
/// The path lengths and the lists are derived from the frames alone. They are in no checkpoint, and
/// no answer depends on them.
class GrainContacts {
 public:
  explicit GrainContacts(ContactSettings settings, ContactEngine engine = ContactEngine::near,
                         SimdLevel simd = SimdLevel::automatic)
      : settings_{std::move(settings)},
        engine_{engine},
        filter_{point_filter(simd)},
        place_{place_lanes(simd)},
        law_of_nodes_{law_of_nodes(simd)} {}

  /// Lists the pairs anew, which must be sorted by ids; pairs that were listed keep their springs.
  /// `slot_count` grains, of which the first `owned` are not ghosts.
  void rebuild(std::vector<Pair> pairs, std::size_t slot_count, std::size_t owned);

  /// Finds touching nodes and computes the force of every listed pair.
  void evaluate(std::span<const GrainFrame> frames, double time_step) {
    evaluate_interior(frames, time_step, frames.size());
    evaluate_border(frames, time_step);
  }
  /// The same in two parts, for messages that arrive in between. First the pairs of two owned
  /// grains: the frames of ghosts need only their ids. Then the pairs with ghosts. `owned` is that
  /// of the last rebuild().
  void evaluate_interior(std::span<const GrainFrame> frames, double time_step, std::size_t owned);
  void evaluate_border(std::span<const GrainFrame> frames, double time_step);

  /// The sum of all pairs of one grain, in the order of the partners' ids. Adds the losses of the
  /// pairs in which it has the lower id to its ledger.
  [[nodiscard]] Load load_on(std::size_t slot, EnergyLedger& ledger) const;

  /// The springs of the last evaluate() become the memory of the next, and bonds break.
  void commit();

  /// From the next evaluate() on, pairs meet in this cell, as it is then. `motion` tells how it has
  /// moved since the last evaluate().
  void set_cell(const PeriodicCell& cell, const CellMotion& motion);
  /// Sets a bond at every pair that touched in the last evaluate() and has none; the settings must
  /// have the law.
  void set_bonds(std::span<const GrainFrame> frames);
  /// Of pairs whose first grain was among the owned ones.
  [[nodiscard]] const BrokenBonds& broken_bonds() const { return broken_; }
  void adopt(const BrokenBonds& broken) { broken_ = broken; }

  /// Sets the Coulomb coefficient from the next evaluate() on.
  void set_friction(double friction) { settings_.friction = friction; }

  /// In the order of their slots, so that neighbours in space are neighbours in memory, but pairs
  /// with ghosts last.
  [[nodiscard]] std::span<const Pair> pairs() const { return pairs_; }
  [[nodiscard]] std::span<const PairForce> forces() const { return forces_; }
  /// For every grain its pairs, in the order of the partners' ids.
  [[nodiscard]] const PairsOfGrain& pairs_of_grain() const { return pairs_of_grain_; }
  [[nodiscard]] const ContactCounters& counters() const { return counters_; }
  /// Of the grains of the last evaluate(); the plain engine does not update it.
  [[nodiscard]] const DisplacementBound& displacements() const { return displacements_; }

  /// Memory held by lists, pairs and springs.
  [[nodiscard]] std::size_t bytes() const;

  /// Springs and bonds of all pairs that have some, sorted by (id_a, id_b).
  [[nodiscard]] std::vector<PairSprings> springs() const;
  /// Takes over springs and bonds from a checkpoint or another rank, of pairs that have none here.
  /// A rebuild must follow, which lists those pairs.
  void adopt(std::span<const PairSprings> springs);

 private:
  /// What one thread works with.
  struct alignas(64) Scratch {
    std::vector<Touch> touches;
    // Of the chunk in work, per block of lanes: what is computed, and which nodes touch.
    std::vector<LaneWork> work;
    std::vector<std::uint32_t> touching;
    std::vector<PairContext> contexts;  // of active pairs, by master
    std::vector<PairImage> images;      // by pair
    std::vector<std::uint32_t> due;     // pairs to be searched
    std::vector<NodeIndex> nodes;
    std::vector<NearList::Found> found;
    ContactCounters counters;
  };
  /// Near lists of one pair: a's nodes on b, b's nodes on a; most rules use one.
  struct NearPair {
    NearList of_a;
    NearList of_b;
  };
  /// One chunk of pairs at one step (grain_contacts_near.cpp).
  class ChunkStep;

  void evaluate_part(bool with_ghosts, std::span<const GrainFrame> frames, double time_step);
  void forget_near_lists();
  [[nodiscard]] bool may_use_near_lists();
  void evaluate_near(std::span<const GrainFrame> frames, double time_step, bool with_ghosts,
                     bool use_near_lists);
  void evaluate_plainly(std::span<const GrainFrame> frames, double time_step, bool with_ghosts);
  template <ContactLaw Law>
  void evaluate_plainly(const Law& law, std::size_t p, std::span<const GrainFrame> frames,
                        double time_step, Scratch& scratch);
  [[nodiscard]] Scratch& scratch() { return scratch_[static_cast<std::size_t>(thread_index())]; }
  const GrainFrame& image_of_b(std::size_t p, std::span<const GrainFrame> frames,
                               std::optional<GrainFrame>& image);
  [[nodiscard]] PairContext context_of(const GrainFrame& a, const GrainFrame& b,
                                       double time_step) const;
  void finish(std::size_t p, std::span<const GrainFrame> frames, ContactCounters& counters);
  [[nodiscard]] std::vector<NodeSpring> springs_of(std::size_t p) const;
  void set_springs(std::size_t p, std::span<const NodeSpring> springs);
  void add_bond(std::size_t p, std::span<const GrainFrame> frames);
  void keep_bond(std::size_t p, const Bond& bond);

  ContactSettings settings_;
  ContactEngine engine_;
  PointFilter filter_;
  PlaceLanes place_;
  LawOfNodes law_of_nodes_;
  std::vector<Pair> pairs_;
  std::size_t interior_{0};            // pairs without ghosts: the first ones
  std::vector<std::uint32_t> by_ids_;  // the pairs sorted by ids
  PairsOfGrain pairs_of_grain_;
  std::vector<PairForce> forces_;
  std::vector<std::uint8_t> acts_;  // per pair: whether its force or losses are to be added
  std::map<std::pair<GrainId, GrainId>, PairSprings> adopted_;  // until the next rebuild
  static constexpr std::uint32_t no_bond = 0xFFFFFFFF;
  std::vector<std::uint32_t> bond_of_pair_;  // in bonds_, or no_bond
  std::vector<Bond> bonds_;                  // those that broke stay until the next rebuild
  std::vector<BondFate> fates_;              // of the bonds at the last evaluate()
  std::vector<std::uint32_t> pair_of_bond_;
  BrokenBonds broken_;
  std::size_t owned_{0};  // frames at the last evaluate()

  // Of the plain engine, by pair: in store_, as of the last commit and of the last evaluate().
  std::vector<SpringRange> springs_of_pair_;
  std::vector<SpringRange> new_springs_of_pair_;
  SpringStore store_;

  // Of the near engine.
  PairLanes lanes_;
  DisplacementBound displacements_;
  std::vector<double> next_check_;  // per pair: the path length at which its lists are searched [m]
  std::vector<NearPair> near_;      // per pair
  std::optional<PeriodicCell> cell_;
  CellMotion cell_motion_;
  std::vector<Vec3> images_;  // with a cell, per pair: which image of b its near lists are about
  double image_distance_{0};  // of two grains, to images that are not nearest, at least [m]
  std::vector<Scratch> scratch_;
  ContactCounters counters_;
};

}  // namespace reckon
