// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reckon/boundary/near_wall.hpp"
#include "reckon/boundary/wall.hpp"
#include "reckon/contact/contact_counters.hpp"
#include "reckon/contact/displacement_bound.hpp"
#include "reckon/contact/spring_store.hpp"
#include "reckon/contact/touch.hpp"
#include "reckon/contact/touch_batch.hpp"
#include "reckon/grains/grain_frame.hpp"
#include "reckon/neighbor/adaptive_skin.hpp"

namespace reckon {

/// What one wall does to one grain at the current step.
struct WallForce {
  Vec3 force;           ///< on the grain [N]
  Vec3 moment;          ///< about its centre of mass [N m]
  double deepest{0};    ///< [m]
  double elastic{0};    ///< stored [J]
  double friction{0};   ///< lost in this step [J]
  double dashpot{0};    ///< lost in this step [J]
  double work{0};       ///< done on the grain by the moving wall in this step [J]
  double stiffness{0};  ///< of all touching nodes, along the normal [N/m]
  double damping{0};    ///< likewise [N s/m]
  /// Sum of the nodes' forces times their levers about the centre of mass, f (x) l [N m].
  Mat3 first_moment{Vec3{}, Vec3{}, Vec3{}};
  std::uint32_t touching{0};

  friend bool operator==(const WallForce&, const WallForce&) = default;
};

/// Springs of one grain on one wall, as a checkpoint or a message carries them.
struct WallSprings {
  GrainId grain;
  WallId wall;
  std::vector<NodeSpring> springs;

  friend bool operator==(const WallSprings&, const WallSprings&) = default;
};

/// Contacts between grains and walls. Used like GrainContacts; the load on a grain is to be added
/// after that of the grains. Candidates are skipped as pairs of grains are.
class WallContacts {
 public:
  explicit WallContacts(std::vector<Wall> walls, ContactEngine engine = ContactEngine::near,
                        SimdLevel simd = SimdLevel::automatic)
      : walls_{std::move(walls)},
        engine_{engine},
        lanes_{law_lanes(simd)},
        removed_(walls_.size(), false),
        path_lengths_(walls_.size(), 0.0) {}

  /// Places the walls for one step. To be called before rebuild and evaluate.
  void move_walls(std::span<const WallPose> poses) { poses_.assign(poses.begin(), poses.end()); }
  /// Sets the Coulomb coefficient of every wall, in their order.
  void set_friction(std::span<const double> friction);
  /// Takes a wall away, with its springs, from the next rebuild on.
  void remove(WallId wall) { removed_[wall.get()] = true; }
  [[nodiscard]] bool is_removed(WallId wall) const { return removed_[wall.get()]; }
  /// Lists the grains that can meet a wall before they or it have moved through their skins.
  void rebuild(std::span<const GrainFrame> frames, const AdaptiveSkin& skin);
  /// `displacements` has followed these frames, slot by slot; the plain engine does not look at it.
  void evaluate(std::span<const GrainFrame> frames, const DisplacementBound& displacements,
                double time_step);
  /// Adds the forces of all walls on one grain, in the order of the scene, and its losses.
  void add_load(std::size_t slot, Load& load, EnergyLedger& ledger) const;
  void commit();

  [[nodiscard]] std::span<const Wall> walls() const { return walls_; }
  [[nodiscard]] std::span<const WallPose> poses() const { return poses_; }

  /// A grain close enough to a wall to be tested; sorted by (slot, wall).
  struct Candidate {
    std::uint32_t slot;
    WallId wall;
    GrainId grain;
  };
  [[nodiscard]] std::span<const Candidate> candidates() const { return candidates_; }
  [[nodiscard]] std::span<const WallForce> forces() const { return forces_; }
  /// Of candidates instead of pairs.
  [[nodiscard]] const ContactCounters& counters() const { return counters_; }

  /// Memory held by lists, candidates and springs.
  [[nodiscard]] std::size_t bytes() const;

  /// Springs of all touching candidates, sorted by (grain, wall).
  [[nodiscard]] std::vector<WallSprings> springs() const;
  /// Takes over springs from a checkpoint or another rank; a rebuild must follow.
  void adopt(std::span<const WallSprings> springs);

 private:
  /// A candidate whose nodes are in the batch of its wall.
  struct Waiting {
    std::size_t candidate;
    std::size_t member;
    double next_check;
  };
  struct alignas(64) Scratch {
    std::vector<Touch> touches;
    std::vector<TouchBatch> batches;  // by wall: each has its own law
    std::vector<Waiting> waiting;
    ContactCounters counters;
  };
  void follow_walls();
  [[nodiscard]] PairContext context_of(std::size_t c, const GrainFrame& grain,
                                       double time_step) const;
  void evaluate_plainly(std::size_t c, const GrainFrame& grain, double time_step, Scratch& scratch);
  void find_nodes(std::size_t c, const GrainFrame& grain, double time_step, double path_length,
                  Scratch& scratch);
  void answer_waiting(std::span<const GrainFrame> frames, double time_step, Scratch& scratch);
  void settle(std::size_t c, double next_check, bool had_springs, ContactCounters& counters);

  std::vector<Wall> walls_;
  ContactEngine engine_;
  LawLanes lanes_;
  std::vector<bool> removed_;  // per wall
  std::vector<WallPose> poses_;
  std::vector<Candidate> candidates_;
  std::vector<std::uint32_t> first_of_slot_;
  std::vector<SpringRange> springs_of_candidate_;
  std::vector<SpringRange> new_springs_of_candidate_;
  std::vector<WallForce> forces_;
  SpringStore store_;

  std::vector<Vec3> seen_displacement_;  // per wall, at the last evaluate()
  std::vector<double> path_lengths_;     // per wall [m]
  std::vector<double> next_check_;       // per candidate
  std::vector<NearWall> near_;           // per candidate
  std::vector<Scratch> scratch_;
  ContactCounters counters_;
};

}  // namespace reckon
