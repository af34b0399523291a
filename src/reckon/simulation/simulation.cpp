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
      grain_contacts_{setup_.contact, setup_.engine, setup_.simd},
      wall_contacts_{setup_.walls, setup_.engine, setup_.simd},
      membrane_contacts_{setup_.engine},
      step_{root_step(ranks, state.step)},
      adaptive_skin_{AdaptiveSkin::with(setup_.skin, setup_.time_step)} {
  for (const ShapeView& shape : shapes_) {
    largest_radius_ = std::max(largest_radius_, shape.bounding_radius);
  }
  for (const GrainState& grain : state.grains) grains_.push_back(grain);
  restore_cell(state);
  grain_contacts_.adopt(state.pair_springs);
  grain_contacts_.adopt(state.broken_bonds);
  wall_contacts_.adopt(state.wall_springs);
  departed_ = state.departed;
  take_over_membrane(state);
  const bool first_stage_begins = take_over_walls_and_stages(state);
  costs_.assign(grains_.size(), 1.0);
  if (first_stage_begins) set_bonds();
}

void Simulation::step() {
  bring_up_to_date();
  evaluate_contacts();
  Stopwatch watch;
  sum_loads(grains_.ledger);
  phase_times_.loads += watch.lap();
  if (cell_) drive_cell();
  advance_grains();
  advance_walls();
  if (cell_) move_cell();
  if (membrane() != nullptr) membrane_->advance(setup_.time_step);
  commit_springs();
  ++step_;
  count_work();
  phase_times_.motion += watch.lap();
  reduce_step_status();
  phase_times_.agreement += watch.lap();
}

/// Frames and, when someone's motion used up the skin, lists: all for where grains are now. Ghosts
/// may still be on their way.
void Simulation::bring_up_to_date() {
  receive_ghosts();
  Stopwatch watch;
  wall_contacts_.move_walls(driven_walls_, step_, setup_.time_step);
  if (membrane() != nullptr) membrane_->follow(wall_contacts_.poses());
  if (lists_are_stale_) {
    remove_outflow_grains();
    if (cell_) adaptive_skin_.gradient = cell_->gradient();
    list_reach_ = 2 * (largest_radius_ + max_skin()) + longest_gap();
    if (cell_) require_wide_cell(list_reach_);
    distribution_.redistribute(grains_, grain_contacts_, wall_contacts_, shapes_, costs_,
                               list_reach_, cell());
    sort_by_morton_order();
    phase_times_.migration += watch.lap();
    distribution_.list_ghosts(grains_);
    phase_times_.border += watch.lap();
    require_shapes();
    update_inertias();
    update_frames(grains_, shapes_, setup_.density, frames_);
    update_ghost_frames();
    phase_times_.frames += watch.lap();
    rebuild_lists();
    phase_times_.lists += watch.lap();
    return;
  }
  distribution_.start_update(grains_);
  ghosts_are_coming_ = true;
  phase_times_.border += watch.lap();
  update_frames(grains_, shapes_, setup_.density, frames_);
  phase_times_.frames += watch.lap();
}

/// Ends an update under way, if there is one.
void Simulation::receive_ghosts() {
  if (!ghosts_are_coming_) return;
  Stopwatch watch;
  distribution_.finish_update();
  ghosts_are_coming_ = false;
  phase_times_.border += watch.lap();
  update_ghost_frames();
  phase_times_.frames += watch.lap();
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

void Simulation::rebuild_lists() {
  grain_contacts_.rebuild(
      distribution_.find_pairs(frames_, adaptive_skin_, longest_gap(), grains_.size()),
      frames_.size());
  wall_contacts_.rebuild(owned_frames(), adaptive_skin_);
  membrane_contacts_.forget();
  listed_grains_.clear();
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) {
    listed_grains_.push_back({grains_.position[slot],
                              adaptive_skin_.of(grains_.velocity[slot], grains_.position[slot])});
  }
  listed_walls_.clear();
  for (const WallPose& pose : wall_contacts_.poses()) {
    listed_walls_.push_back({pose.displacement, adaptive_skin_.of(pose.velocity)});
  }
  cell_since_lists_ = UpperMat3::identity();
  lists_are_stale_ = false;
  ++list_rebuilds_;
  const auto owned = static_cast<std::uint32_t>(grains_.size());
  const auto& pairs = grain_contacts_.pairs();
  shared_pairs_ = static_cast<std::uint64_t>(std::count_if(
      pairs.begin(), pairs.end(),
      [owned](const Pair& pair) { return pair.slot_a >= owned || pair.slot_b >= owned; }));
  costs_ = grain_costs(pairs, grains_.size());
  cost_ = std::accumulate(costs_.begin(), costs_.end(), 0.0);
}

void Simulation::count_work() {
  ++done_.steps;
  done_.grain_steps += grains_.size();
  done_.ghost_steps += distribution_.ghosts().size();
  done_.pair_steps += grain_contacts_.pairs().size();
  done_.shared_pair_steps += shared_pairs_;
  done_.work += cost_;
}

void Simulation::evaluate_contacts() {
  Stopwatch watch;
  if (cell_) grain_contacts_.set_cell(*cell_, cell_motion());
  cell_since_evaluation_ = UpperMat3::identity();
  // Inner pairs and walls hide the time in which ghosts are on their way.
  grain_contacts_.evaluate(frames_, setup_.time_step, grains_.size(), [&] {
    phase_times_.grain_contacts += watch.lap();
    wall_contacts_.evaluate(owned_frames(), grain_contacts_.displacements(), setup_.time_step);
    phase_times_.wall_contacts += watch.lap();
    receive_ghosts();
    watch = {};
  });
  phase_times_.grain_contacts += watch.lap();
  evaluate_membrane();
  phase_times_.wall_contacts += watch.lap();
}

/// The largest of all ranks for the lists about to be made [m].
double Simulation::max_skin() const {
  return distribution_.ranks().max(
      parallel_max(grains_.size(), adaptive_skin_.min, [&](std::size_t slot) {
        return adaptive_skin_.of(grains_.velocity[slot], grains_.position[slot]);
      }));
}

/// Between the faces of a bond: its grains must see each other though they do not touch [m].
double Simulation::longest_gap() const {
  return setup_.contact.bond ? setup_.contact.bond->longest_gap() : 0;
}

/// Whether some grain of this rank, or some wall, has moved as far as it was listed for.
bool Simulation::skin_is_used_up() const {
  const auto used_up = [](const Listed& listed, const Vec3& place) {
    return !(squared_norm(place - listed.place) < listed.skin * listed.skin);
  };
  const auto poses = poses_at(setup_.walls, driven_walls_, step_, setup_.time_step);
  for (std::size_t w = 0; w < listed_walls_.size(); ++w) {
    if (used_up(listed_walls_[w], poses[w].displacement)) return true;
  }
  if (cell_) {
    const CellMotion motion{cell_->center(), cell_since_lists_, list_reach_};
    const double shared = 0.5 * motion.of_pair();
    return parallel_max(grains_.size(), 0, [&](std::size_t slot) {
             const Listed& listed = listed_grains_[slot];
             const Vec3 own = grains_.position[slot] - motion.carried(listed.place);
             return norm(own) + shared < listed.skin ? 0.0 : 1.0;
           }) > 0;
  }
  return parallel_max(grains_.size(), 0, [&](std::size_t slot) {
           return used_up(listed_grains_[slot], grains_.position[slot]) ? 1.0 : 0.0;
         }) > 0;
}

/// One small reduction per step: do lists serve one more step, and is everybody still well?
void Simulation::reduce_step_status() {
  constexpr double fine = 0;
  constexpr double stale = 1;
  constexpr double failed = 2;
  double news = skin_is_used_up() ? stale : fine;
  news = std::max(news, parallel_max(grains_.size(), fine, [&](std::size_t slot) {
                    if (!motion_is_finite(slot)) return failed;
                    return is_out(slot) ? stale : fine;
                  }));
  if (membrane() != nullptr && !membrane_->is_finite()) news = failed;
  news = distribution_.ranks().max(news);
  lists_are_stale_ = news >= stale;
  if (news >= failed) fail_on_motion();
}

void Simulation::sum_loads(std::span<EnergyLedger> ledgers) {
  contact_loads_.assign(grains_.size(), Load{});
  grain_contacts_.add_loads(contact_loads_, ledgers);
  wall_contacts_.add_loads(contact_loads_, ledgers);
  if (membrane() != nullptr) membrane_contacts_.add_loads(contact_loads_, ledgers);
}

/// Acceleration by body forces other than gravity [m/s^2].
Vec3 Simulation::push_besides_gravity(std::size_t slot) const {
  return setup_.body_force.acceleration_besides_gravity(grains_.id[slot], step_);
}

Load Simulation::total_load(std::size_t slot, const Vec3& push) const {
  Load load = contact_loads_[slot];
  load.force += inertias_[slot].mass * (setup_.body_force.gravity + push);
  return load;
}

void Simulation::advance_grains() {
  const double dt = setup_.time_step;
  parallel_for(grains_.size(), 64, [&](std::size_t slot) {
    const Vec3 push = push_besides_gravity(slot);
    const Load load = total_load(slot, push);
    const Inertia& body = inertias_[slot];
    const Mat3& rotation = frames_[slot].rotation;
    Kick before = velocities_of(grains_, slot);
    before.velocity = velocity_in_cell(slot);
    const Vec3 velocity_before = before.velocity;
    const Vec3 spin_before = before.angular_velocity_body;
    EnergyLedger& ledger = grains_.ledger[slot];
    if (grains_.prescribed[slot] != 0) {
      // What holds the grain to its course supplies the opposite of its load.
      const Vec3 spin_world = rotation * spin_before;
      ledger.wall_work -= (dot(load.force, velocity_before) + dot(load.moment, spin_world)) * dt;
      drift(grains_, slot, {grains_.velocity[slot], spin_before, {}}, dt);
      return;
    }
    Kick half = kick(before, rotation, load, body, setup_.damping, dt);
    const Vec3 velocity = 0.5 * (velocity_before + half.velocity);
    const Vec3 spin = 0.5 * (spin_before + half.angular_velocity_body);
    ledger.damping +=
        setup_.damping * dt *
        (body.mass * squared_norm(velocity) + dot(hadamard(body.moments, spin), spin));
    ledger.body_work += body.mass * dot(push, velocity) * dt;
    if (!cell_) return drift(grains_, slot, half, dt);
    const Vec3 alone = half.velocity;
    const Vec3 along = cell_gradient_ * (grains_.position[slot] - cell_->center());
    half.velocity += along;
    drift(grains_, slot, half, dt);
    ledger.wall_work += work_of_cell_on(slot, alone, along);
  });
}

void Simulation::commit_springs() {
  grain_contacts_.commit();
  wall_contacts_.commit();
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
