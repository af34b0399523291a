// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reckon/core/error.hpp"
#include "reckon/core/stopwatch.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {

Simulation::Simulation(SimulationSetup setup, const SimulationState& state)
    : setup_{std::move(setup)},
      shapes_{setup_.shapes->begin(), setup_.shapes->end()},
      grain_contacts_{setup_.contact, setup_.engine},
      wall_contacts_{setup_.walls, setup_.engine},
      step_{state.step} {
  for (const GrainState& grain : state.grains) grains_.push_back(grain);
  grain_contacts_.restore(state.pair_springs);
  wall_contacts_.restore(state.wall_springs);
}

void Simulation::step() {
  Stopwatch watch;
  place_frames();
  phase_times_.frames += watch.lap();
  if (lists_are_stale()) rebuild_lists();
  phase_times_.lists += watch.lap();
  grain_contacts_.evaluate(frames_, setup_.time_step);
  phase_times_.grain_contacts += watch.lap();
  wall_contacts_.evaluate(frames_, setup_.time_step);
  phase_times_.wall_contacts += watch.lap();
  sum_loads(grains_.ledger);
  phase_times_.loads += watch.lap();
  advance_grains();
  commit_springs();
  ++step_;
  require_finite_motion();
  phase_times_.motion += watch.lap();
}

void Simulation::place_frames() {
  update_frames(grains_, shapes_, setup_.density, frames_);
  wall_contacts_.move_walls(step_, setup_.time_step);
}

bool Simulation::lists_are_stale() const {
  if (!lists_exist_) return true;
  double moved_squared = parallel_max(grains_.size(), 0, [&](std::size_t slot) {
    return squared_norm(grains_.position[slot] - listed_positions_[slot]);
  });
  for (std::size_t w = 0; w < listed_wall_displacement_.size(); ++w) {
    moved_squared = std::max(moved_squared, squared_norm(wall_contacts_.poses()[w].displacement -
                                                         listed_wall_displacement_[w]));
  }
  const double budget = 0.5 * setup_.skin;
  return !(moved_squared < budget * budget);
}

void Simulation::rebuild_lists() {
  grain_contacts_.rebuild(frames_, setup_.skin);
  wall_contacts_.rebuild(frames_, setup_.skin);
  listed_positions_ = grains_.position;
  listed_wall_displacement_.clear();
  for (const WallPose& pose : wall_contacts_.poses()) {
    listed_wall_displacement_.push_back(pose.displacement);
  }
  lists_exist_ = true;
  ++list_rebuilds_;
}

void Simulation::sum_loads(std::span<EnergyLedger> ledgers) {
  contact_loads_.assign(grains_.size(), Load{});
  grain_contacts_.add_loads(contact_loads_, ledgers);
  wall_contacts_.add_loads(contact_loads_, ledgers);
}

Inertia Simulation::inertia(std::size_t slot) const {
  const MassProperties& shape = shapes_[grains_.shape[slot].get()].mass;
  return {setup_.density * shape.volume, setup_.density * shape.inertia};
}

Load Simulation::total_load(std::size_t slot) const {
  const Vec3 acceleration = setup_.body_force.gravity +
                            setup_.body_force.acceleration_besides_gravity(grains_.id[slot], step_);
  Load load = contact_loads_[slot];
  load.force += inertia(slot).mass * acceleration;
  return load;
}

void Simulation::advance_grains() {
  const double dt = setup_.time_step;
  parallel_for(grains_.size(), 64, [&](std::size_t slot) {
    const Load load = total_load(slot);
    const Inertia body = inertia(slot);
    const Vec3 velocity_before = grains_.velocity[slot];
    const Vec3 spin_before = grains_.angular_velocity_body[slot];
    EnergyLedger& ledger = grains_.ledger[slot];
    if (grains_.prescribed[slot] != 0) {
      // What holds the grain to its course supplies the opposite of its load.
      const Vec3 spin_world = rotation_matrix(grains_.orientation[slot]) * spin_before;
      ledger.wall_work -= (dot(load.force, velocity_before) + dot(load.moment, spin_world)) * dt;
      drift(grains_, slot, {velocity_before, spin_before, {}}, dt);
      return;
    }
    const Kick half = kick(grains_, slot, load, body, setup_.damping, dt);
    const Vec3 velocity = 0.5 * (velocity_before + half.velocity);
    const Vec3 spin = 0.5 * (spin_before + half.angular_velocity_body);
    ledger.damping +=
        setup_.damping * dt *
        (body.mass * squared_norm(velocity) + dot(hadamard(body.moments, spin), spin));
    const Vec3 pushed = setup_.body_force.acceleration_besides_gravity(grains_.id[slot], step_);
    ledger.body_work += body.mass * dot(pushed, velocity) * dt;
    drift(grains_, slot, half, dt);
  });
}

void Simulation::commit_springs() {
  grain_contacts_.commit();
  wall_contacts_.commit();
}

void Simulation::require_finite_motion() const {
  const auto finite = [&](std::size_t slot) {
    return is_finite(grains_.position[slot]) && is_finite(grains_.velocity[slot]) &&
           is_finite(grains_.angular_velocity_body[slot]);
  };
  const double bad = parallel_max(grains_.size(), -1, [&](std::size_t slot) {
    return finite(slot) ? -1.0 : static_cast<double>(slot);
  });
  if (bad < 0) return;
  const auto slot = static_cast<std::size_t>(bad);
  throw Error{{.place = fmt::format("grain {}, step {}", grains_.id[slot].get(), step_),
               .problem = "its motion is no longer a number",
               .reason = "forces grew without bound, most often because the time step is too large "
                         "for the stiffness or grains overlapped deeply at the start",
               .fix = "Lower time.step_fraction, or look at the last files for deep overlaps."}};
}

void Simulation::refresh_contacts() {
  place_frames();
  if (lists_are_stale()) rebuild_lists();
  grain_contacts_.evaluate(frames_, setup_.time_step);
  wall_contacts_.evaluate(frames_, setup_.time_step);
}

SimulationState Simulation::state() const {
  SimulationState state;
  state.step = step_;
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) {
    state.grains.push_back(grains_.state(slot));
  }
  std::sort(state.grains.begin(), state.grains.end(),
            [](const GrainState& a, const GrainState& b) { return a.id < b.id; });
  state.pair_springs = grain_contacts_.springs();
  state.wall_springs = wall_contacts_.springs();
  return state;
}

}  // namespace reckon
