// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "reckon/core/error.hpp"
#include "reckon/core/stopwatch.hpp"
#include "reckon/neighbor/grain_costs.hpp"
#include "reckon/neighbor/space_order.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {

namespace {

std::size_t total_count(const Communicator& ranks, std::size_t own) {
  auto count = static_cast<std::int64_t>(own);
  ranks.sum({&count, 1});
  return static_cast<std::size_t>(count);
}

std::uint64_t root_step(const Communicator& ranks, std::uint64_t step) {
  auto value = static_cast<std::int64_t>(ranks.is_root() ? step : 0);
  ranks.sum({&value, 1});
  return static_cast<std::uint64_t>(value);
}

}  // namespace

Simulation::Simulation(SimulationSetup setup, const SimulationState& state,
                       const Communicator& ranks)
    : setup_{std::move(setup)},
      shapes_{setup_.shapes.views()},
      distribution_{ranks, setup_.decomposition, total_count(ranks, state.grains.size()),
                    total_count(ranks, state.grains.size() + state.departed.size())},
      step_{root_step(ranks, state.step)},
      active_{setup_.body_force.gravity, setup_.damping},
      departed_{state.departed},
      container_{setup_, state, ranks},
      interactions_{setup_, state},
      list_skins_{setup_.skin, setup_.time_step} {
  for (const ShapeView& shape : shapes_) {
    largest_radius_ = std::max(largest_radius_, shape.bounding_radius);
  }
  for (const GrainState& grain : state.grains) grains_.push_back(grain);
  costs_.assign(grains_.size(), 1.0);
  if (membrane() != nullptr) interactions_.remove_wall(setup_.membrane->mould);
  restore_stages(state);
}

/// The paper's algorithm (section 2). Each line is explained in ARCHITECTURE.md, "One step in
/// detail".
void Simulation::step() {
  update();
  compute_forces();
  Stopwatch watch;
  drive_container();
  const GrainStatus grains = advance_grains();
  container_.advance();
  interactions_.commit();
  ++step_;
  count_work();
  done_.phases.motion += watch.lap();
  reduce_step_status(grains);
  done_.phases.agreement += watch.lap();
}

/// Brings walls, frames and lists to the current step. If no lists are made, the new states of the
/// ghosts are still on their way afterwards.
void Simulation::update() {
  receive_ghosts();
  Stopwatch watch;
  container_.place(step_);
  interactions_.move_walls(container_.poses());
  if (lists_are_stale_) {
    rebuild_lists();
    return;
  }
  distribution_.start_update(grains_);
  ghosts_are_coming_ = true;
  done_.phases.border += watch.lap();
}

/// Migration, ghosts and new lists, for where the grains are now.
void Simulation::rebuild_lists() {
  Stopwatch watch;
  remove_outflow_grains();
  if (cell() != nullptr) list_skins_.follow_cell(*cell());
  const double max_skin = distribution_.ranks().max(list_skins_.max_of(grains_));
  list_reach_ = 2 * (largest_radius_ + max_skin) + longest_gap();
  container_.require_width(list_reach_, step_);
  distribution_.redistribute(grains_, interactions_.grains(), interactions_.walls(), shapes_,
                             costs_, list_reach_, cell());
  sort_by_morton_order();
  done_.phases.migration += watch.lap();
  distribution_.list_ghosts(grains_);
  done_.phases.border += watch.lap();
  require_shapes();
  update_inertias();
  update_frames(grains_, shapes_, setup_.density, frames_);
  update_ghost_frames();
  done_.phases.frames += watch.lap();
  interactions_.rebuild(
      distribution_.find_pairs(frames_, list_skins_.skin(), longest_gap(), grains_.size()), frames_,
      grains_.size(), list_skins_.skin());
  list_skins_.record(grains_, container_.poses());
  container_.mark_lists();
  lists_are_stale_ = false;
  ++done_.list_rebuilds;
  const auto owned = static_cast<std::uint32_t>(grains_.size());
  const auto pairs = interactions_.grains().pairs();
  shared_pairs_ = static_cast<std::uint64_t>(std::count_if(
      pairs.begin(), pairs.end(),
      [owned](const Pair& pair) { return pair.slot_a >= owned || pair.slot_b >= owned; }));
  costs_ = grain_costs(pairs, grains_.size());
  cost_ = std::accumulate(costs_.begin(), costs_.end(), 0.0);
  done_.phases.lists += watch.lap();
}

/// Waits for the new states of the ghosts, if they are on their way.
void Simulation::receive_ghosts() {
  if (!ghosts_are_coming_) return;
  Stopwatch watch;
  distribution_.finish_update();
  ghosts_are_coming_ = false;
  done_.phases.border += watch.lap();
  update_ghost_frames();
  done_.phases.frames += watch.lap();
}

/// The forces of all contacts. The states of the ghosts arrive while those between owned grains and
/// on walls are computed.
void Simulation::compute_forces() {
  const double dt = setup_.time_step;
  Stopwatch watch;
  if (const CellDrive* drive = container_.cell_drive()) {
    // Pairs stay listed while they are at most twice as far apart as when lists were made.
    const double farthest = 4 * (largest_radius_ + list_skins_.skin().max);
    interactions_.set_cell(drive->cell(), drive->since_evaluation(farthest));
  }
  container_.mark_evaluation();
  interactions_.compute_interior(frames_, grains_.size(), dt);
  done_.phases.grain_contacts += watch.lap();
  interactions_.compute_walls(owned_frames(), dt);
  done_.phases.wall_contacts += watch.lap();
  receive_ghosts();
  watch = {};
  interactions_.compute_border(frames_, dt);
  done_.phases.grain_contacts += watch.lap();
  if (membrane() != nullptr) {
    container_.load_membrane(interactions_.compute_membrane(*membrane(), owned_frames(), dt),
                             membrane_pressure(), distribution_.ranks());
  }
  done_.phases.wall_contacts += watch.lap();
}

/// Their springs go with them when lists are made anew.
void Simulation::remove_outflow_grains() {
  if (setup_.outflows.empty()) return;
  const auto before = static_cast<std::int64_t>(departed_.size());
  Grains staying;
  std::vector<double> costs;
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) {
    if (is_out(slot)) {
      departed_.push_back({step_, grains_.state(slot)});
    } else {
      staying.push_back(grains_.state(slot));
      costs.push_back(costs_[slot]);
    }
  }
  std::int64_t left = static_cast<std::int64_t>(departed_.size()) - before;
  if (left > 0) {
    grains_ = std::move(staying);
    costs_ = std::move(costs);
  }
  distribution_.ranks().sum({&left, 1});
  distribution_.expect_fewer(static_cast<std::size_t>(left));
}

/// Neighbours in space become neighbours in memory.
void Simulation::sort_by_morton_order() {
  const std::vector<std::uint32_t> order = space_order(places_in(cell(), grains_.position));
  if (std::is_sorted(order.begin(), order.end())) return;
  Grains ordered;
  for (const std::uint32_t slot : order) ordered.push_back(grains_.state(slot));
  grains_ = std::move(ordered);
}

/// Grids and nodes of the shapes of all grains that this rank sees.
void Simulation::require_shapes() {
  std::vector<bool> needed(shapes_.size(), false);
  for (const ShapeId shape : grains_.shape) needed[shape.get()] = true;
  for (const BorderGrain& ghost : distribution_.ghosts()) needed[ghost.shape.get()] = true;
  setup_.shapes.require(needed);
}

void Simulation::update_inertias() {
  inertias_.clear();
  for (const ShapeId shape : grains_.shape) {
    const MassProperties& mass = shapes_[shape.get()].mass;
    inertias_.push_back({setup_.density * mass.volume, setup_.density * mass.inertia});
  }
}

void Simulation::update_ghost_frames() {
  const std::span<const BorderGrain> ghosts = distribution_.ghosts();
  frames_.resize(grains_.size() + ghosts.size());
  parallel_for(ghosts.size(), 64, [&](std::size_t n) {
    const BorderGrain& ghost = ghosts[n];
    frames_[grains_.size() + n] = frame_of(
        ghost.id, shapes_[ghost.shape.get()], ghost.state.position, ghost.state.orientation,
        ghost.state.velocity, ghost.state.angular_velocity_body, setup_.density);
  });
}

void Simulation::count_work() {
  ++done_.steps;
  done_.grain_steps += grains_.size();
  done_.ghost_steps += distribution_.ghosts().size();
  done_.pair_steps += interactions_.grains().pairs().size();
  done_.shared_pair_steps += shared_pairs_;
  done_.work += cost_;
}

/// Between the faces of a bond: its grains must see each other though they do not touch [m].
double Simulation::longest_gap() const {
  return setup_.contact.bond ? setup_.contact.bond->longest_gap() : 0;
}

/// One small reduction per step: do lists serve one more step, and is every state finite?
void Simulation::reduce_step_status(GrainStatus grains) {
  GrainStatus status = grains;
  const auto worsen = [&status](GrainStatus other) { status = std::max(status, other); };
  if (list_skins_.used_up_by_walls(container_.poses_at_step(step_))) worsen(GrainStatus::stale);
  if (membrane() != nullptr && !membrane()->is_finite()) worsen(GrainStatus::failed);
  const double worst = distribution_.ranks().max(static_cast<double>(status));
  lists_are_stale_ = worst >= static_cast<double>(GrainStatus::stale);
  if (worst >= static_cast<double>(GrainStatus::failed)) fail_on_motion();
}

/// Sets the rates of the cell and the speeds of the walls from the forces at this step.
void Simulation::drive_container() {
  const StageSetup* now = stage();
  container_.drive_cell(now, [this] { return cell_reaction(); });
  if (now != nullptr) container_.drive_walls(*now, [this] { return wall_reactions(); });
}

/// Acceleration by body forces other than gravity [m/s^2].
Vec3 Simulation::push_besides_gravity(std::size_t slot) const {
  return setup_.body_force.acceleration_besides_gravity(grains_.id[slot], step_);
}

Load Simulation::total_load(std::size_t slot, const Vec3& push, EnergyLedger& ledger) const {
  Load load = interactions_.load_on(slot, ledger);
  load.force += inertias_[slot].mass * (active_.gravity + push);
  return load;
}

/// One loop over the grains: each sums its forces, moves, and gets its frame of the next step.
/// Returns the worst status.
GrainStatus Simulation::advance_grains() {
  std::optional<CellMotion> cell_motion;
  if (const CellDrive* cell = container_.cell_drive()) {
    cell_motion = cell->next_since_lists(list_reach_);
  }
  struct alignas(64) Worst {  // a cache line for each thread
    GrainStatus status{GrainStatus::fine};
  };
  std::vector<Worst> worst(static_cast<std::size_t>(thread_count()));
  parallel_for(grains_.size(), 64, [&](std::size_t slot) {
    advance_grain(slot);
    frames_[slot] =
        frame_of(grains_.id[slot], shapes_[grains_.shape[slot].get()], grains_.position[slot],
                 grains_.orientation[slot], grains_.velocity[slot],
                 grains_.angular_velocity_body[slot], setup_.density);
    GrainStatus& status = worst[static_cast<std::size_t>(thread_index())].status;
    status = std::max(status, status_of(slot, cell_motion ? &*cell_motion : nullptr));
  });
  GrainStatus status = GrainStatus::fine;
  for (const Worst& of_thread : worst) status = std::max(status, of_thread.status);
  return status;
}

void Simulation::advance_grain(std::size_t slot) {
  const double dt = setup_.time_step;
  const Vec3 push = push_besides_gravity(slot);
  EnergyLedger& ledger = grains_.ledger[slot];
  const Load load = total_load(slot, push, ledger);
  const Inertia& body = inertias_[slot];
  const Mat3& rotation = frames_[slot].rotation;
  const Vec3 position = grains_.position[slot];
  Kick before = velocities_of(grains_, slot);
  before.velocity = container_.relative_velocity(position, grains_.velocity[slot]);
  const Vec3 velocity_before = before.velocity;
  const Vec3 spin_before = before.angular_velocity_body;
  if (grains_.prescribed[slot] != 0) {
    // What holds the grain to its course supplies the opposite of its load.
    const Vec3 spin_world = rotation * spin_before;
    ledger.wall_work -= (dot(load.force, velocity_before) + dot(load.moment, spin_world)) * dt;
    drift(grains_, slot, {grains_.velocity[slot], spin_before, {}}, dt);
    return;
  }
  Kick half = kick(before, rotation, load, body, active_.damping, dt);
  const Vec3 velocity = 0.5 * (velocity_before + half.velocity);
  const Vec3 spin = 0.5 * (spin_before + half.angular_velocity_body);
  ledger.damping += active_.damping * dt *
                    (body.mass * squared_norm(velocity) + dot(hadamard(body.moments, spin), spin));
  ledger.body_work += body.mass * dot(push, velocity) * dt;
  const CellDrive* const cell = container_.cell_drive();
  if (cell == nullptr) return drift(grains_, slot, half, dt);
  const Vec3 relative = half.velocity;
  half.velocity += cell->drift_velocity(position);
  drift(grains_, slot, half, dt);
  ledger.wall_work += cell->work_on(body.mass, active_.gravity, position, grains_.position[slot],
                                    relative, grains_.velocity[slot], dt);
}

GrainStatus Simulation::status_of(std::size_t slot, const CellMotion* cell_motion) const {
  if (!motion_is_finite(slot)) return GrainStatus::failed;
  const bool stale =
      is_out(slot) || list_skins_.used_up_by(slot, grains_.position[slot], cell_motion);
  return stale ? GrainStatus::stale : GrainStatus::fine;
}

bool Simulation::is_out(std::size_t slot) const {
  return std::any_of(
      setup_.outflows.begin(), setup_.outflows.end(),
      [&](const PlaneSurface& plane) { return plane.distance(grains_.position[slot]) < 0; });
}

bool Simulation::motion_is_finite(std::size_t slot) const {
  return is_finite(grains_.position[slot]) && is_finite(grains_.velocity[slot]) &&
         is_finite(grains_.angular_velocity_body[slot]);
}

void Simulation::fail_on_motion() const {
  double first_bad = -std::numeric_limits<double>::infinity();  // minus the lowest id
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) {
    if (!motion_is_finite(slot)) {
      first_bad = std::max(first_bad, -static_cast<double>(grains_.id[slot].get()));
    }
  }
  first_bad = distribution_.ranks().max(first_bad);
  const std::string who = std::isfinite(first_bad)
                              ? fmt::format("grain {:.0f}", std::abs(first_bad))
                              : std::string{"the membrane"};
  throw Error{
      {.place = fmt::format("{}, step {}", who, step_),
       .problem = "its motion is no longer a number",
       .reason = "forces grew without bound, most often because the time step is too large "
                 "for the stiffness or grains overlapped deeply at the start",
       .fix =
           "Lower time.step_fraction or time.step, or look at the last files for deep overlaps."}};
}

}  // namespace reckon
