// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reckon/boundary/cell_control.hpp"
#include "reckon/boundary/membrane.hpp"
#include "reckon/boundary/membrane_contacts.hpp"
#include "reckon/boundary/wall_contacts.hpp"
#include "reckon/boundary/wall_control.hpp"
#include "reckon/contact/grain_contacts.hpp"
#include "reckon/domain/shape_store.hpp"
#include "reckon/grains/grain_frame.hpp"
#include "reckon/grains/periodic_cell.hpp"
#include "reckon/motion/body_force.hpp"
#include "reckon/motion/integrator.hpp"
#include "reckon/simulation/distribution.hpp"
#include "reckon/simulation/measurement.hpp"
#include "reckon/simulation/performance.hpp"
#include "reckon/simulation/phase_times.hpp"

namespace reckon {

/// The pressure around a membrane during a stage.
struct MembranePressure {
  double pressure{0};  ///< [Pa]
  double ramp{0};      ///< how long it takes to get there [s]
};

/// The axis that a test is about: that of the walls, or of the part of the cell, that a stage
/// drives.
struct DrivenAxis {
  Vec3 normal_unit{0, 0, 1};
  std::vector<WallId> walls;       ///< that are driven along it; none in a periodic cell
  std::optional<CellAxis> cell{};  ///< of a periodic cell; may be a shear
};

/// What holds for one stage of a test.
struct StageSetup {
  std::string name;
  double friction{0};                 ///< between grains
  std::vector<double> wall_friction;  ///< by wall
  Vec3 gravity;                       ///< [m/s^2]
  double damping{0};                  ///< global damping xi [1/s]
  std::vector<WallControl> controls;
  std::vector<CellControl> cell_controls;
  /// Of the stage before that drives something, or the next one; z if none does.
  DrivenAxis axis;
  std::optional<MembranePressure> membrane;  ///< none: not in place yet
  bool sets_bonds{false};                    ///< at its start, where grains touch
};

/// A periodic cell at the start.
struct CellSetup {
  Vec3 center;                                     ///< stays where it is [m]
  std::array<bool, 3> periodic{true, true, true};  ///< by axis
  Vec3 size;                                       ///< edges, along the axes [m]
};

/// What stays the same from the first step to the last.
struct SimulationSetup {
  ShapeStore shapes;
  double density{0};  ///< [kg/m^3]
  ContactSettings contact;
  std::vector<Wall> walls;
  std::optional<MembraneSetup> membrane;  ///< takes its place with the first stage that has it
  std::optional<CellSetup> cell;
  std::vector<PlaneSurface> outflows;  ///< a grain whose centre is behind one leaves
  BodyForce body_force;
  double damping{0};    ///< global damping xi [1/s]
  double time_step{0};  ///< [s]
  /// What takes turns: a stage sets friction, gravity and damping anew. Empty: no stages.
  std::vector<StageSetup> stages;
  double skin{0};  ///< of the pair lists (AdaptiveSkin); changes the speed, never the answer [m]
  ContactEngine engine{ContactEngine::near};                     ///< likewise
  SimdLevel simd{SimdLevel::automatic};                          ///< likewise
  DecompositionKind decomposition{DecompositionKind::balanced};  ///< likewise
};

/// A grain that an outflow took out, as it was then.
struct DepartedGrain {
  std::uint64_t step{0};
  GrainState grain;

  friend bool operator==(const DepartedGrain&, const DepartedGrain&) = default;
};

/// What changes: all that a checkpoint must hold to go on to the same bits.
struct SimulationState {
  std::uint64_t step{0};
  std::vector<GrainState> grains;         ///< sorted by id
  std::vector<PairSprings> pair_springs;  ///< sorted by ids
  std::vector<WallSprings> wall_springs;  ///< sorted by grain, then wall
  std::vector<DepartedGrain> departed;    ///< sorted by id
  std::vector<DrivenWall> driven_walls;   ///< by wall; empty at the start
  /// The step at which each stage so far began; the last is under way. Empty without stages, and
  /// at the start.
  std::vector<std::uint64_t> stage_starts;
  MembraneState membrane;
  std::optional<CellState> cell;  ///< none at the start
  BrokenBonds broken_bonds;

  friend bool operator==(const SimulationState&, const SimulationState&) = default;
};

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
  /// What controls have made of the walls.
  [[nodiscard]] std::span<const DrivenWall> driven_walls() const { return driven_walls_; }
  /// The membrane where it has taken its place, else nothing.
  [[nodiscard]] const Membrane* membrane() const {
    return membrane_ && membrane_->in_place() ? &*membrane_ : nullptr;
  }
  /// The grain of the lowest id whose centre is beyond the membrane; those that keep their
  /// velocities do not count. Collective.
  [[nodiscard]] std::optional<GrainOutside> grain_outside_membrane() const;
  [[nodiscard]] const MembraneContacts& membrane_contacts() const { return membrane_contacts_; }
  /// The periodic cell as of the current step, else nothing.
  [[nodiscard]] const PeriodicCell* cell() const { return cell_ ? &*cell_ : nullptr; }
  [[nodiscard]] const CellState& cell_state() const { return cell_state_; }
  /// What grains do to the cell as of the last evaluation, summed over all ranks. Collective.
  [[nodiscard]] CellReaction cell_reaction() const;
  /// From b's centre to a's, in a periodic cell from that of b's nearest image [m].
  [[nodiscard]] Vec3 branch(const Pair& pair) const {
    const Vec3& a = frames_[pair.slot_a].position;
    const Vec3& b = frames_[pair.slot_b].position;
    return cell_ ? cell_->branch(a, b) : a - b;
  }
  /// The space that walls, or walls and membrane, close off as of the last evaluation, and where
  /// the stage under way began; or a cell that is periodic along all axes. Nothing where they do
  /// not, or its volume is not known.
  [[nodiscard]] std::optional<Enclosure> space() const;
  [[nodiscard]] std::optional<Enclosure> space_at_stage_start() const;
  /// The same at step 0, where the membrane is still its mould.
  [[nodiscard]] std::optional<Enclosure> space_at_start() const;
  /// What the walls feel as of the last evaluation, summed over all ranks. Collective.
  [[nodiscard]] std::vector<WallReaction> wall_reactions() const;
  /// Where the grains of this rank are, then its ghosts, as of the last evaluation.
  [[nodiscard]] std::span<const GrainFrame> frames() const { return frames_; }
  [[nodiscard]] std::uint64_t list_rebuilds() const { return list_rebuilds_; }
  [[nodiscard]] const PhaseTimes& phase_times() const { return phase_times_; }
  [[nodiscard]] const GrainContacts& grain_contacts() const { return grain_contacts_; }
  [[nodiscard]] const WallContacts& wall_contacts() const { return wall_contacts_; }
  [[nodiscard]] double mass(std::size_t slot) const {
    return setup_.density * shapes_[grains_.shape[slot].get()].mass.volume;
  }

 private:
  void bring_up_to_date();
  void remove_outflow_grains();
  void sort_by_morton_order();
  void require_shapes();
  void update_inertias();
  void update_ghost_frames();
  void receive_ghosts();
  void rebuild_lists();
  void count_work();
  void evaluate_contacts();
  [[nodiscard]] std::span<const GrainFrame> owned_frames() const {
    return std::span{frames_}.first(grains_.size());
  }
  void sum_loads(std::span<EnergyLedger> ledgers);
  /// Returns whether the first stage begins here.
  bool take_over_walls_and_stages(const SimulationState& state);
  void take_over_membrane(const SimulationState& state);
  void apply_stage();
  void set_bonds();
  void let_membrane_take_place();
  [[nodiscard]] double membrane_pressure() const;
  void evaluate_membrane();
  void restore_cell(const SimulationState& state);
  void begin_stage_of_cell();
  void drive_cell();
  void move_cell();
  [[nodiscard]] CellMotion cell_motion() const;
  [[nodiscard]] double cell_work_now() const;
  [[nodiscard]] double work_of_cell_on(std::size_t slot, const Vec3& alone,
                                       const Vec3& along) const;
  void require_wide_cell(double reach) const;
  [[nodiscard]] Vec3 velocity_in_cell(std::size_t slot) const;
  void advance_grains();
  void advance_walls();
  void commit_springs();
  void reduce_step_status();

  [[nodiscard]] double max_skin() const;
  [[nodiscard]] double longest_gap() const;
  [[nodiscard]] bool skin_is_used_up() const;
  [[nodiscard]] bool is_out(std::size_t slot) const;
  [[nodiscard]] bool is_outside(std::size_t slot) const;
  [[nodiscard]] bool motion_is_finite(std::size_t slot) const;
  [[noreturn]] void fail_on_motion() const;
  [[nodiscard]] Vec3 push_besides_gravity(std::size_t slot) const;
  [[nodiscard]] Load total_load(std::size_t slot, const Vec3& push) const;

  SimulationSetup setup_;
  std::span<const ShapeView> shapes_;  // views of setup_.shapes
  Distribution distribution_;
  double largest_radius_{0};  // of all shapes [m]
  Grains grains_;
  std::vector<GrainFrame> frames_;  // owned grains, then ghosts
  bool ghosts_are_coming_{false};   // their states are on their way
  std::vector<Inertia> inertias_;   // of the owned grains
  std::vector<Load> contact_loads_;
  GrainContacts grain_contacts_;
  WallContacts wall_contacts_;
  std::optional<Membrane> membrane_;  // the same on all ranks
  MembraneContacts membrane_contacts_;
  std::vector<DepartedGrain> departed_;  // on this rank
  std::uint64_t step_{0};
  std::vector<DrivenWall> driven_walls_;  // the same on all ranks
  std::optional<PeriodicCell> cell_;      // the same on all ranks
  CellState cell_state_;
  std::optional<PeriodicCell> next_cell_;  // a step on
  UpperMat3 cell_gradient_;                // of its velocity over the step to come [1/s]
  UpperMat3 cell_step_;                    // deformation over the step to come
  UpperMat3 cell_since_evaluation_{UpperMat3::identity()};  // deformation
  UpperMat3 cell_since_lists_{UpperMat3::identity()};       // likewise
  double list_reach_{0};  // no two grains closer than this are without a list [m]
  std::vector<std::uint64_t> stage_starts_;

  /// Where a grain was, or a wall's displacement, when the lists were made, and how far it may go.
  struct Listed {
    Vec3 place;      // [m]
    double skin{0};  // [m]
  };
  AdaptiveSkin adaptive_skin_;
  std::vector<Listed> listed_grains_;
  std::vector<Listed> listed_walls_;
  bool lists_are_stale_{true};
  std::uint64_t list_rebuilds_{0};
  PhaseTimes phase_times_;
  RankPerformance done_;           // the counters of it that step() keeps
  std::uint64_t shared_pairs_{0};  // listed pairs with a ghost
  std::vector<double> costs_;      // of the owned grains, as of the last lists
  double cost_{0};                 // their sum
};

}  // namespace reckon
