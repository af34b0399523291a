// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "reckon/grains/grain_frame.hpp"
#include "reckon/motion/integrator.hpp"
#include "reckon/simulation/container.hpp"
#include "reckon/simulation/distribution.hpp"
#include "reckon/simulation/interactions.hpp"
#include "reckon/simulation/list_skins.hpp"
#include "reckon/simulation/measurement.hpp"
#include "reckon/simulation/performance.hpp"
#include "reckon/simulation/phase_times.hpp"
#include "reckon/simulation/reactions.hpp"
#include "reckon/simulation/simulation_setup.hpp"
#include "reckon/simulation/simulation_state.hpp"

namespace reckon {

/// A grain that has left the sample through its membrane.
struct GrainOutside {
  GrainId grain;
  Vec3 position;  ///< [m]
};

/// One pair of touching grains, or a grain and a wall, as output shows it.
struct ContactRecord {
  GrainId grain;
  bool with_wall{false};
  /// The other grain's id, or the wall's place in the scene; the membrane comes after all walls.
  std::uint32_t partner{0};
  Vec3 from;          ///< the grain's centre; in a periodic cell, in the cell [m]
  Vec3 to;            ///< the partner's centre, or the foot of the grain's centre on the wall
  Vec3 force;         ///< on `grain` [N]
  double deepest{0};  ///< largest penetration of a node [m]
  std::uint32_t touching{0};  ///< nodes
  bool bonded{false};         ///< and the bond holds; its force is in `force`

  friend bool operator==(const ContactRecord&, const ContactRecord&) = default;
};

/// What the stage under way sets; without stages, what the run sets.
struct ActiveStage {
  Vec3 gravity;       ///< [m/s^2]
  double damping{0};  ///< global damping xi [1/s]
};

/// A grain after a step, from good to bad.
enum class GrainStatus {
  fine,   ///< its lists serve one more step
  stale,  ///< lists must be made again
  failed  ///< its motion is no longer a number
};

/// The level-set discrete element method. `step()` is the paper's algorithm on one screen.
class Simulation {
 public:
  /// With several ranks all functions that say so are collective; `state` counts on the root only,
  /// the other ranks pass an empty one.
  Simulation(SimulationSetup setup, const SimulationState& state, const Communicator& ranks = {});

  /// Moves everything on by one time step. Collective. Throws Error on all ranks, naming the grain,
  /// when a grain's motion is no longer a number.
  void step();

  /// Ends the stage under way and begins the next, from the current step on. Collective.
  void begin_next_stage();

  /// What holds at the current step, on all ranks. Collective. Changes nothing.
  [[nodiscard]] Measurement measure();
  /// The contacts at the current step, pairs sorted by ids, then walls. Collective; whole on the
  /// root, empty elsewhere. Changes nothing.
  [[nodiscard]] std::vector<ContactRecord> contacts();
  /// All grains, sorted by id. Collective; whole on the root, empty elsewhere.
  [[nodiscard]] std::vector<GrainState> grain_states();
  /// Everything needed to go on. Collective; whole on the root, empty elsewhere.
  [[nodiscard]] SimulationState state();
  /// What every rank did since the simulation began, by rank. Collective; whole on the root, empty
  /// elsewhere.
  [[nodiscard]] std::vector<RankPerformance> performance() const;

  [[nodiscard]] const SimulationSetup& setup() const { return setup_; }
  /// The grains that this rank owns.
  [[nodiscard]] const Grains& grains() const { return grains_; }
  [[nodiscard]] const Distribution& distribution() const { return distribution_; }
  [[nodiscard]] std::span<const ShapeView> shapes() const { return shapes_; }
  [[nodiscard]] std::uint64_t step_number() const { return step_; }
  [[nodiscard]] double time() const { return static_cast<double>(step_) * setup_.time_step; }
  /// The stage under way; nothing without stages.
  [[nodiscard]] const StageSetup* stage() const {
    return setup_.stages.empty() ? nullptr : &setup_.stages[stage_starts_.size() - 1];
  }
  /// The step at which each stage so far began.
  [[nodiscard]] std::span<const std::uint64_t> stage_starts() const { return stage_starts_; }
  [[nodiscard]] const ActiveStage& active_stage() const { return active_; }
  /// Walls, membrane and periodic cell.
  [[nodiscard]] const Container& container() const { return container_; }
  [[nodiscard]] const Interactions& interactions() const { return interactions_; }
  /// The membrane where it has replaced its mould, else nothing.
  [[nodiscard]] const Membrane* membrane() const { return container_.membrane(); }
  /// The grain of the lowest id whose centre is beyond the membrane; grains with a prescribed
  /// motion do not count. Collective.
  [[nodiscard]] std::optional<GrainOutside> grain_outside_membrane() const;
  /// The periodic cell as of the current step, else nothing.
  [[nodiscard]] const PeriodicCell* cell() const { return container_.cell(); }
  /// Of the cell, which must be there.
  [[nodiscard]] const CellState& cell_state() const { return container_.cell_drive()->state(); }
  /// What the grains do to the cell, which must be there, and to the walls as of the last
  /// evaluation, summed over all ranks. Collective.
  [[nodiscard]] CellReaction cell_reaction() const {
    return reckon::cell_reaction(interactions_.grains(), frames_, grains_.size(), *cell(),
                                 distribution_.ranks());
  }
  [[nodiscard]] std::vector<WallReaction> wall_reactions() const {
    return reckon::wall_reactions(interactions_.walls(), distribution_.ranks());
  }
  /// The enclosed space as of the last evaluation, where the stage under way began, and at step 0:
  /// see Container.
  [[nodiscard]] std::optional<Enclosure> space() const { return container_.space(); }
  [[nodiscard]] std::optional<Enclosure> space_at_stage_start() const {
    return container_.space_at_stage_start(stage_starts_.empty() ? 0 : stage_starts_.back());
  }
  [[nodiscard]] std::optional<Enclosure> space_at_start() const {
    return container_.space_at_start();
  }
  /// Where the grains of this rank are, then its ghosts, as of the last evaluation.
  [[nodiscard]] std::span<const GrainFrame> frames() const { return frames_; }
  [[nodiscard]] std::uint64_t list_rebuilds() const { return done_.list_rebuilds; }
  [[nodiscard]] const PhaseTimes& phase_times() const { return done_.phases; }
  [[nodiscard]] const GrainContacts& grain_contacts() const { return interactions_.grains(); }
  [[nodiscard]] const WallContacts& wall_contacts() const { return interactions_.walls(); }
  [[nodiscard]] const MembraneContacts& membrane_contacts() const {
    return interactions_.membrane();
  }
  [[nodiscard]] double mass(std::size_t slot) const {
    return setup_.density * shapes_[grains_.shape[slot].get()].mass.volume;
  }

 private:
  void update();
  void remove_outflow_grains();
  void sort_by_morton_order();
  void require_shapes();
  void update_inertias();
  void update_ghost_frames();
  void rebuild_lists();
  void receive_ghosts();
  void compute_forces();
  void drive_container();
  [[nodiscard]] GrainStatus advance_grains();
  void advance_grain(std::size_t slot);
  void count_work();
  void reduce_step_status(GrainStatus grains);

  void restore_stages(const SimulationState& state);
  void apply_stage();
  void set_bonds();
  void replace_mould();
  [[nodiscard]] double membrane_pressure() const;

  [[nodiscard]] std::span<const GrainFrame> owned_frames() const {
    return std::span{frames_}.first(grains_.size());
  }
  [[nodiscard]] double longest_gap() const;
  [[nodiscard]] GrainStatus status_of(std::size_t slot, const CellMotion* cell_motion) const;
  [[nodiscard]] bool is_out(std::size_t slot) const;
  [[nodiscard]] bool is_outside(std::size_t slot) const;
  [[nodiscard]] bool motion_is_finite(std::size_t slot) const;
  [[noreturn]] void fail_on_motion() const;
  [[nodiscard]] Vec3 push_besides_gravity(std::size_t slot) const;
  [[nodiscard]] Load total_load(std::size_t slot, const Vec3& push, EnergyLedger& ledger) const;

  SimulationSetup setup_;              // constant, except that shapes are read when first needed
  std::span<const ShapeView> shapes_;  // views of setup_.shapes
  double largest_radius_{0};           // of all shapes [m]
  Distribution distribution_;

  std::uint64_t step_{0};
  std::vector<std::uint64_t> stage_starts_;
  ActiveStage active_;

  Grains grains_;
  std::vector<GrainFrame> frames_;       // owned grains, then ghosts
  std::vector<Inertia> inertias_;        // of the owned grains
  std::vector<DepartedGrain> departed_;  // on this rank
  Container container_;
  Interactions interactions_;

  ListSkins list_skins_;
  double list_reach_{0};  // no two grains closer than this are without a list [m]
  bool lists_are_stale_{true};
  bool ghosts_are_coming_{false};  // their states are on their way
  std::vector<double> costs_;      // of the owned grains, as of the last lists
  double cost_{0};                 // their sum
  std::uint64_t shared_pairs_{0};  // listed pairs with a ghost
  RankPerformance done_;           // what step() counts and times
};

}  // namespace reckon
