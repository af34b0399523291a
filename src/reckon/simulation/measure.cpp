// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "reckon/core/exact_sum.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {
namespace {

struct ExactVec3 {
  ExactSum x, y, z;
  void add(const Vec3& v) {
    x.add(v.x);
    y.add(v.y);
    z.add(v.z);
  }
  [[nodiscard]] Vec3 value() const { return {x.value(), y.value(), z.value()}; }
};

/// What is summed over all grains, pairs and walls.
struct Sums {
  ExactSum translation, rotation, gravity, elastic;
  ExactSum friction, dashpot, damping, body_work, wall_work;
  ExactSum net_force, contact_force;
  ExactVec3 momentum;
};

void add_ledger(Sums& sums, const EnergyLedger& ledger) {
  sums.friction.add(ledger.friction);
  sums.dashpot.add(ledger.dashpot);
  sums.damping.add(ledger.damping);
  sums.body_work.add(ledger.body_work);
  sums.wall_work.add(ledger.wall_work);
}

EnergyBudget budget(const Sums& sums) {
  return {sums.translation.value(), sums.rotation.value(),  sums.gravity.value(),
          sums.elastic.value(),     sums.friction.value(),  sums.dashpot.value(),
          sums.damping.value(),     sums.body_work.value(), sums.wall_work.value()};
}

/// Where the line from a grain's centre meets the wall at a right angle.
Vec3 foot_on_wall(const Wall& wall, const WallPose& pose, const Vec3& center) {
  return std::visit(
      [&](const auto& surface) {
        const Vec3 p = center - pose.displacement;
        return center - surface.distance(p) * surface.gradient(p);
      },
      wall.surface);
}

}  // namespace

Measurement Simulation::measure() {
  refresh_contacts();
  std::vector<EnergyLedger> ledgers = grains_.ledger;  // with the losses up to this very step
  sum_loads(ledgers);

  Measurement result;
  result.step = step_;
  result.time = time();
  Sums sums;
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) {
    const Inertia body = inertia(slot);
    const Load load = total_load(slot);
    Vec3 velocity = grains_.velocity[slot];
    Vec3 spin = grains_.angular_velocity_body[slot];
    if (grains_.prescribed[slot] == 0) {
      // Velocities at the step: the mean of both half steps.
      const Kick half = kick(grains_, slot, load, body, setup_.damping, setup_.time_step);
      velocity = 0.5 * (velocity + half.velocity);
      spin = 0.5 * (spin + half.angular_velocity_body);
      sums.net_force.add(norm(load.force));
    }
    sums.translation.add(0.5 * body.mass * squared_norm(velocity));
    sums.rotation.add(0.5 * dot(hadamard(body.moments, spin), spin));
    sums.gravity.add(-body.mass * dot(setup_.body_force.gravity, grains_.position[slot]));
    sums.momentum.add(body.mass * velocity);
    add_ledger(sums, ledgers[slot]);
    result.largest_speed = std::max(result.largest_speed, norm(velocity));
  }
  for (const PairForce& pair : grain_contacts_.forces()) {
    if (pair.touching == 0) continue;
    ++result.contacts;
    result.touching_nodes += pair.touching;
    sums.elastic.add(pair.elastic);
    sums.contact_force.add(norm(pair.force_on_a));
    result.deepest_overlap = std::max(result.deepest_overlap, pair.deepest);
  }
  std::vector<ExactVec3> on_walls(setup_.walls.size());
  for (std::size_t c = 0; c < wall_contacts_.forces().size(); ++c) {
    const WallForce& wall = wall_contacts_.forces()[c];
    if (wall.touching == 0) continue;
    ++result.wall_contacts;
    result.touching_nodes += wall.touching;
    sums.elastic.add(wall.elastic);
    sums.contact_force.add(norm(wall.force));
    on_walls[wall_contacts_.candidates()[c].wall.get()].add(-wall.force);
    result.deepest_overlap = std::max(result.deepest_overlap, wall.deepest);
  }
  result.energy = budget(sums);
  result.momentum = sums.momentum.value();
  for (const ExactVec3& force : on_walls) result.wall_force.push_back(force.value());
  const auto touching_pairs = static_cast<double>(result.contacts + result.wall_contacts);
  const auto grain_count = static_cast<double>(grains_.size());
  if (grain_count > 0) {
    result.coordination =
        static_cast<double>(2 * result.contacts + result.wall_contacts) / grain_count;
  }
  if (touching_pairs > 0 && sums.contact_force.value() > 0) {
    result.unbalanced_ratio =
        (sums.net_force.value() / grain_count) / (sums.contact_force.value() / touching_pairs);
  }
  return result;
}

std::vector<ContactRecord> Simulation::contacts() {
  refresh_contacts();
  std::vector<ContactRecord> records;
  for (std::size_t p = 0; p < grain_contacts_.pairs().size(); ++p) {
    const PairForce& force = grain_contacts_.forces()[p];
    if (force.touching == 0) continue;
    const Pair& pair = grain_contacts_.pairs()[p];
    records.push_back({pair.id_a, false, pair.id_b.get(), grains_.position[pair.slot_a],
                       grains_.position[pair.slot_b], force.force_on_a, force.deepest,
                       force.touching});
  }
  for (std::size_t c = 0; c < wall_contacts_.candidates().size(); ++c) {
    const WallForce& force = wall_contacts_.forces()[c];
    if (force.touching == 0) continue;
    const auto& candidate = wall_contacts_.candidates()[c];
    const Vec3& center = grains_.position[candidate.slot];
    records.push_back({candidate.grain, true, candidate.wall.get(), center,
                       foot_on_wall(setup_.walls[candidate.wall.get()],
                                    wall_contacts_.poses()[candidate.wall.get()], center),
                       force.force, force.deepest, force.touching});
  }
  return records;
}

}  // namespace reckon
