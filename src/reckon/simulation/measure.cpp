// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

#include "reckon/boundary/membrane_side.hpp"
#include "reckon/math/portable.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/simulation/exact_totals.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {
namespace {

/// What is summed over all grains, pairs and walls.
struct Sums {
  ExactSum translation, rotation, gravity, elastic;
  ExactSum friction, dashpot, damping, fracture, body_work, wall_work, departed_energy;
  ExactSum net_force, contact_force, stretch;
  ExactSum free_mass, carried_mass, free_kinetic, lift;
  ExactVec3 momentum;
  std::vector<ExactVec3> on_walls;
  std::int64_t grains{0}, departed{0}, contacts{0}, wall_contacts{0}, touching_nodes{0};
  std::int64_t bonds{0}, broken_in_tension{0}, broken_in_shear{0}, outside{0};

  /// Adds up what all ranks hold, digit by digit.
  void reduce(const Communicator& ranks) {
    std::vector<ExactSum*> exact{&translation, &rotation,   &gravity,         &elastic,
                                 &friction,    &dashpot,    &damping,         &body_work,
                                 &wall_work,   &net_force,  &contact_force,   &momentum.x,
                                 &momentum.y,  &momentum.z, &departed_energy, &stretch,
                                 &fracture,    &free_mass,  &carried_mass,    &free_kinetic,
                                 &lift};
    for (ExactVec3& wall : on_walls) wall.list(exact);
    std::array<std::int64_t, 9> counts{grains,   contacts, wall_contacts,     touching_nodes,
                                       departed, bonds,    broken_in_tension, broken_in_shear,
                                       outside};
    add_up(ranks, exact, counts);
    grains = counts[0];
    contacts = counts[1];
    wall_contacts = counts[2];
    touching_nodes = counts[3];
    departed = counts[4];
    bonds = counts[5];
    broken_in_tension = counts[6];
    broken_in_shear = counts[7];
    outside = counts[8];
  }
};

void add_ledger(Sums& sums, const EnergyLedger& ledger) {
  sums.friction.add(ledger.friction);
  sums.dashpot.add(ledger.dashpot);
  sums.damping.add(ledger.damping);
  sums.fracture.add(ledger.fracture);
  sums.body_work.add(ledger.body_work);
  sums.wall_work.add(ledger.wall_work);
}

EnergyBudget budget(const Sums& sums) {
  return {sums.translation.value(), sums.rotation.value(),       sums.gravity.value(),
          sums.elastic.value(),     sums.friction.value(),       sums.dashpot.value(),
          sums.damping.value(),     sums.fracture.value(),       sums.body_work.value(),
          sums.wall_work.value(),   sums.departed_energy.value()};
}

}  // namespace

/// Whether a grain's centre is behind a wall that bounds the sample.
bool Simulation::is_outside(std::size_t slot) const {
  const std::span<const WallPose> poses = container_.poses();
  for (std::uint32_t w = 0; w < setup_.walls.size(); ++w) {
    if (!container_.is_in_place(WallId{w})) continue;
    const Vec3 place = grains_.position[slot] - poses[w].displacement;
    const double distance = std::visit([&](const auto& surface) { return surface.distance(place); },
                                       setup_.walls[w].surface);
    if (distance < 0) return true;
  }
  return false;
}

Measurement Simulation::measure() {
  update();
  compute_forces();
  std::vector<EnergyLedger> ledgers = grains_.ledger;  // with the losses up to this very step

  const auto diameter = [&](std::size_t slot) {
    return portable::cbrt(6 / std::numbers::pi * frames_[slot].shape->mass.volume);
  };
  std::vector<std::uint8_t> carried(grains_.size(), 0);
  const auto carry = [&](std::size_t slot) {
    if (slot < carried.size()) carried[slot] = 1;
  };
  Measurement result;
  result.step = step_;
  result.time = time();
  Sums sums;
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) {
    const Inertia& body = inertias_[slot];
    const Load load = total_load(slot, push_besides_gravity(slot), ledgers[slot]);
    Vec3 velocity = container_.relative_velocity(grains_.position[slot], grains_.velocity[slot]);
    Vec3 spin = grains_.angular_velocity_body[slot];
    if (grains_.prescribed[slot] == 0) {
      // Velocities at the step: the mean of both half steps.
      const Kick half = kick({velocity, spin, grains_.angular_increment_body[slot]},
                             frames_[slot].rotation, load, body, active_.damping, setup_.time_step);
      velocity = 0.5 * (velocity + half.velocity);
      spin = 0.5 * (spin + half.angular_velocity_body);
      sums.net_force.add(norm(load.force));
      sums.free_mass.add(body.mass);
      sums.free_kinetic.add(0.5 * body.mass * squared_norm(velocity));
      sums.free_kinetic.add(0.5 * dot(hadamard(body.moments, spin), spin));
      sums.lift.add(body.mass * norm(active_.gravity) * diameter(slot));
      if (is_outside(slot)) ++sums.outside;
    }
    sums.translation.add(0.5 * body.mass * squared_norm(velocity));
    sums.rotation.add(0.5 * dot(hadamard(body.moments, spin), spin));
    sums.gravity.add(-body.mass * dot(active_.gravity, grains_.position[slot]));
    sums.momentum.add(body.mass * velocity);
    add_ledger(sums, ledgers[slot]);
    result.largest_speed = std::max(result.largest_speed, norm(velocity));
  }
  sums.on_walls.resize(setup_.walls.size());
  interactions_.visit_contacts([&](const ContactView& contact) {
    const bool between_grains = contact.partner == ContactPartner::grain;
    const double size = norm(contact.force);
    if (size > 0) {
      carry(contact.slot);
      if (between_grains) carry(contact.other);
    }
    // A pair that two ranks share is counted by the owner of its first grain.
    if (contact.slot >= grains_.size()) return;
    ++(between_grains ? sums.contacts : sums.wall_contacts);
    if (contact.bonded) ++sums.bonds;
    sums.touching_nodes += contact.touching;
    sums.elastic.add(contact.elastic);
    sums.contact_force.add(size);
    if (contact.partner == ContactPartner::wall) sums.on_walls[contact.other].add(-contact.force);
    const double smaller = between_grains
                               ? std::min(diameter(contact.slot), diameter(contact.other))
                               : diameter(contact.slot);
    result.deepest_overlap = std::max(result.deepest_overlap, contact.deepest);
    result.overlap_ratio = std::max(result.overlap_ratio, contact.deepest / smaller);
  });
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) {
    if (carried[slot] != 0 && grains_.prescribed[slot] == 0) sums.carried_mass.add(mass(slot));
  }
  // All ranks hold the whole membrane.
  const std::uint32_t told = membrane() != nullptr && distribution_.ranks().is_root()
                                 ? static_cast<std::uint32_t>(membrane()->nodes().size())
                                 : 0;
  for (std::uint32_t node = 0; node < told; ++node) {
    sums.translation.add(membrane()->kinetic_energy(node, setup_.time_step));
    sums.elastic.add(membrane()->bond_energy(node));
    sums.stretch.add(membrane()->bond_energy(node));
    add_ledger(sums, membrane()->ledger(node));
  }
  for (const DepartedGrain& gone : departed_) {
    const MassProperties& form = shapes_[gone.grain.shape.get()].mass;
    const double mass = setup_.density * form.volume;
    const Vec3& spin = gone.grain.angular_velocity_body;
    sums.departed_energy.add(0.5 * mass * squared_norm(gone.grain.velocity) +
                             0.5 * setup_.density * dot(hadamard(form.inertia, spin), spin) -
                             mass * dot(active_.gravity, gone.grain.position));
    add_ledger(sums, gone.grain.ledger);
  }
  sums.grains = static_cast<std::int64_t>(grains_.size());
  sums.departed = static_cast<std::int64_t>(departed_.size());
  sums.broken_in_tension =
      static_cast<std::int64_t>(interactions_.grains().broken_bonds().in_tension);
  sums.broken_in_shear = static_cast<std::int64_t>(interactions_.grains().broken_bonds().in_shear);
  const Communicator& ranks = distribution_.ranks();
  sums.reduce(ranks);
  result.deepest_overlap = ranks.max(result.deepest_overlap);
  result.overlap_ratio = ranks.max(result.overlap_ratio);
  result.largest_speed = ranks.max(result.largest_speed);

  result.grains = static_cast<std::uint64_t>(sums.grains);
  result.departed = static_cast<std::uint64_t>(sums.departed);
  result.contacts = static_cast<std::uint64_t>(sums.contacts);
  result.wall_contacts = static_cast<std::uint64_t>(sums.wall_contacts);
  result.touching_nodes = static_cast<std::uint64_t>(sums.touching_nodes);
  result.bonds = static_cast<std::uint64_t>(sums.bonds);
  result.broken_bonds = {static_cast<std::uint64_t>(sums.broken_in_tension),
                         static_cast<std::uint64_t>(sums.broken_in_shear)};
  result.energy = budget(sums);
  if (const CellDrive* drive = container_.cell_drive(); drive != nullptr) {
    result.energy.wall_work += drive->is_moving()
                                   ? drive->work_until_now(cell_reaction(), setup_.time_step)
                                   : drive->state().work;
  }
  result.momentum = sums.momentum.value();
  for (const ExactVec3& force : sums.on_walls) result.wall_force.push_back(force.value());
  if (membrane() != nullptr) {
    result.membrane_pressure = membrane()->pressure();
    result.membrane_stretch = sums.stretch.value();
    for (std::uint32_t node = 0; node < membrane()->nodes().size(); ++node) {
      if (membrane()->is_touched(node)) ++result.membrane_nodes;
    }
  }
  const auto touching_pairs = static_cast<double>(sums.contacts + sums.wall_contacts);
  const auto grain_count = static_cast<double>(sums.grains);
  if (grain_count > 0) {
    result.coordination = static_cast<double>(2 * sums.contacts + sums.wall_contacts) / grain_count;
  }
  constexpr double infinite = std::numeric_limits<double>::infinity();
  result.unbalanced_ratio =
      sums.contact_force.value() > 0
          ? (sums.net_force.value() / grain_count) / (sums.contact_force.value() / touching_pairs)
          : infinite;
  const double free_mass = sums.free_mass.value();
  if (free_mass > 0) result.carried_share = sums.carried_mass.value() / free_mass;
  // Without gravity the springs hold the grains; under gravity alone springs may be so stiff that
  // they store next to nothing, and the energy to rise by a diameter is the measure.
  const double holding = result.energy.elastic + sums.lift.value();
  result.kinetic_ratio = holding > 0 ? sums.free_kinetic.value() / holding : infinite;
  result.outside = static_cast<std::uint64_t>(sums.outside);
  return result;
}

std::optional<GrainOutside> Simulation::grain_outside_membrane() const {
  if (membrane() == nullptr) return std::nullopt;
  constexpr double none = -std::numeric_limits<double>::infinity();
  const MembraneSide side{*membrane()};
  const auto rank_of = [](GrainId id) {
    return -static_cast<double>(id.get());
  };  // the lowest wins
  const Communicator& ranks = distribution_.ranks();
  const double found = ranks.max(parallel_max(grains_.size(), none, [&](std::size_t slot) {
    const bool out = grains_.prescribed[slot] == 0 && side.is_outside(grains_.position[slot]);
    return out ? rank_of(grains_.id[slot]) : none;
  }));
  if (found == none) return std::nullopt;
  Vec3 position{none, none, none};
  for (std::size_t slot = 0; slot < grains_.size(); ++slot) {
    if (rank_of(grains_.id[slot]) == found) position = grains_.position[slot];
  }
  for (int axis = 0; axis < 3; ++axis) position[axis] = ranks.max(position[axis]);
  return GrainOutside{GrainId{static_cast<std::uint32_t>(-found)}, position};
}

}  // namespace reckon
