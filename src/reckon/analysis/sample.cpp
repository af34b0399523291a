// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "reckon/boundary/enclosure.hpp"
#include "reckon/math/portable.hpp"
#include "reckon/simulation/exact_totals.hpp"

namespace reckon {
namespace {

/// The sums over all ranks.
struct Sums {
  ExactMat3 pairs, wall_branches, on_walls;  // force (x) length [N m]
  ExactMat3 normals, branches;
  ExactSum solids, weighted_diameter;  // [m^3], [m^4]
  ExactSum force, squared_force;       // [N], [N^2]
  std::int64_t grains{0}, contacts{0}, with_normal{0}, degrees{0}, held{0}, held_degrees{0};

  void reduce(const Communicator& ranks) {
    std::vector<ExactSum*> exact{&solids, &weighted_diameter, &force, &squared_force};
    for (ExactMat3* sum : {&pairs, &wall_branches, &on_walls, &normals, &branches}) {
      sum->list(exact);
    }
    std::array<std::int64_t, 6> counts{grains, contacts, with_normal, degrees, held, held_degrees};
    add_up(ranks, exact, counts);
    grains = counts[0];
    contacts = counts[1];
    with_normal = counts[2];
    degrees = counts[3];
    held = counts[4];
    held_degrees = counts[5];
  }
};

/// Adds the contacts that this rank counts: on walls and the membrane, and those between grains
/// whose first grain it owns. Counts the contacts of each own grain, those with ghosts included.
/// Returns the largest force between grains [N].
double add_contacts(const Simulation& simulation, const Vec3& origin, Sums& sums,
                    std::vector<std::int64_t>& degree) {
  const std::size_t owned = degree.size();
  const std::span<const GrainFrame> frames = simulation.frames();
  double largest = 0;
  simulation.interactions().visit_contacts([&](const ContactView& contact) {
    if (contact.slot < owned) ++degree[contact.slot];
    const Vec3& position = frames[contact.slot].position;
    if (contact.partner != ContactPartner::grain) {
      sums.wall_branches.add(contact.first_moment);
      sums.on_walls.add(outer(contact.force, position - origin));
      sums.on_walls.add(contact.first_moment);
      return;
    }
    if (contact.other < owned) ++degree[contact.other];
    if (contact.slot >= owned) return;
    const Vec3 branch = simulation.container().branch(position, frames[contact.other].position);
    const double size = norm(contact.force);
    ++sums.contacts;
    sums.pairs.add(outer(contact.force, branch));
    sums.branches.add(outer(normalized(branch), normalized(branch)));
    sums.force.add(size);
    sums.squared_force.add(size * size);
    largest = std::max(largest, size);
  });
  return largest;
}

/// A pair of two ranks is counted by the owner of its first grain.
void add_normals(const Simulation& simulation, Sums& sums) {
  std::vector<GrainId> own_ids = simulation.grains().id;
  std::sort(own_ids.begin(), own_ids.end());
  for (const PairSprings& springs : simulation.grain_contacts().springs()) {
    if (!std::binary_search(own_ids.begin(), own_ids.end(), springs.id_a)) continue;
    Vec3 normal;
    for (const NodeSpring& spring : springs.springs) {
      normal += spring.master_is_b ? -spring.normal : spring.normal;
    }
    if (normal == Vec3{}) continue;  // held only by its bond
    ++sums.with_normal;
    sums.normals.add(outer(normalized(normal), normalized(normal)));
  }
}

void add_grains(const Simulation& simulation, std::span<const std::int64_t> degree, Sums& sums) {
  for (std::size_t slot = 0; slot < degree.size(); ++slot) {
    const double volume = simulation.shapes()[simulation.grains().shape[slot].get()].mass.volume;
    ++sums.grains;
    sums.solids.add(volume);
    sums.weighted_diameter.add(volume * portable::cbrt(6 / std::numbers::pi * volume));
    sums.degrees += degree[slot];
    if (degree[slot] < 2) continue;
    ++sums.held;
    sums.held_degrees += degree[slot];
  }
}

Vec3 shortening(const Vec3& from, const Vec3& to) {
  return {portable::log(from.x / to.x), portable::log(from.y / to.y), portable::log(from.z / to.z)};
}

/// Which of the axes a unit vector lies along, if any.
std::optional<int> along_axis(const Vec3& unit) {
  constexpr double nearly = 1 - 1e-12;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(unit[axis]) >= nearly) return axis;
  }
  return std::nullopt;
}

double axial_strain(const Simulation& simulation, const DrivenAxis& axis, const Enclosure& start,
                    const Enclosure& now, const Vec3& total) {
  if (axis.cell && is_shear(*axis.cell)) {
    const int place = static_cast<int>(*axis.cell) - static_cast<int>(CellAxis::xy);
    return simulation.cell_state().shear[place];
  }
  if (const auto along = along_axis(axis.normal_unit)) return total[*along];
  const std::uint32_t wall = axis.walls.front().get();
  return portable::log(start.volume / start.areas[wall] / (now.volume / now.areas[wall]));
}

double axial_deviator(const DrivenAxis& axis, const Mat3& stress, double mean) {
  const Mat3 s = symmetric_part(stress);
  if (axis.cell && is_shear(*axis.cell)) {  // grains resist shear against its direction
    const double shear = *axis.cell == CellAxis::xy   ? s.row_x.y
                         : *axis.cell == CellAxis::xz ? s.row_x.z
                                                      : s.row_y.z;
    return -std::numbers::sqrt3 * shear;
  }
  return 1.5 * (dot(axis.normal_unit, s * axis.normal_unit) - mean);
}

/// The largest rate of strain by axis over the last step [1/s].
double largest_rate(const Simulation& simulation, const Enclosure& now) {
  const double dt = simulation.setup().time_step;
  if (const Membrane* membrane = simulation.membrane()) {  // along the axis: it bulges more slowly
    const auto poses = simulation.container().poses();
    const MembraneState& state = membrane->state();
    const Vec3 apart = poses[state.lid.get()].velocity - poses[state.floor.get()].velocity;
    return std::abs(dot(apart, state.start.axis_unit)) * now.areas[state.lid.get()] / now.volume;
  }
  if (const PeriodicCell* cell = simulation.cell()) {
    const UpperMat3 rate = cell->gradient();
    return std::max({std::abs(rate.diagonal.x), std::abs(rate.diagonal.y),
                     std::abs(rate.diagonal.z), std::abs(rate.xy), std::abs(rate.xz),
                     std::abs(rate.yz)});
  }
  std::vector<WallPose> before(simulation.container().poses().begin(),
                               simulation.container().poses().end());
  for (WallPose& pose : before) pose.displacement -= dt * pose.velocity;
  const auto space = enclosure_of(simulation.setup().walls, before);
  if (!space) return 0;
  const Vec3 rate = shortening(space->size(), now.size()) / dt;
  return std::max({std::abs(rate.x), std::abs(rate.y), std::abs(rate.z)});
}

void fill_network(const Sums& sums, double largest_force, SampleMeasurement& result) {
  const auto over = [](std::int64_t a, std::int64_t b) {
    return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : 0;
  };
  result.coordination = over(sums.degrees, sums.grains);
  result.mechanical_coordination = over(sums.held_degrees, sums.held);
  result.rattlers = static_cast<std::uint64_t>(sums.grains - sums.held);
  if (sums.contacts == 0) return;
  const auto count = static_cast<double>(sums.contacts);
  result.branch_tensor = (1 / count) * sums.branches.value();
  if (sums.with_normal > 0) {
    result.contact_tensor = (1 / static_cast<double>(sums.with_normal)) * sums.normals.value();
  }
  result.mean_force = sums.force.value() / count;
  if (!(result.mean_force > 0)) return;
  const double variance =
      sums.squared_force.value() / count - result.mean_force * result.mean_force;
  result.force_variation = std::sqrt(std::max(variance, 0.0)) / result.mean_force;
  result.largest_force = largest_force / result.mean_force;
}

}  // namespace

SampleMeasurement measure_sample(const Simulation& simulation) {
  SampleMeasurement result;
  const auto space = simulation.space();
  const Vec3 centre = space ? 0.5 * (space->low + space->high) : Vec3{};
  Sums sums;
  std::vector<std::int64_t> degree(simulation.grains().size(), 0);
  double largest_force = add_contacts(simulation, centre, sums, degree);
  add_normals(simulation, sums);
  add_grains(simulation, degree, sums);
  const Communicator& ranks = simulation.distribution().ranks();
  sums.reduce(ranks);
  largest_force = ranks.max(largest_force);
  fill_network(sums, largest_force, result);
  if (!space) return result;

  result.enclosed = true;
  result.volume = space->volume;
  result.size = space->size();
  const double solids = sums.solids.value();
  if (solids > 0) result.void_ratio = (space->volume - solids) / solids;
  if (const auto start = simulation.space_at_stage_start()) {
    result.strain = shortening(start->size(), space->size());
    result.volumetric_strain = portable::log(start->volume / space->volume);
  }
  const DrivenAxis axis = simulation.stage() != nullptr ? simulation.stage()->axis : DrivenAxis{};
  if (const auto start = simulation.space_at_start()) {
    result.total_strain = shortening(start->size(), space->size());
    result.total_volumetric_strain = portable::log(start->volume / space->volume);
    result.axial_strain = axial_strain(simulation, axis, *start, *space, result.total_strain);
  }
  // The walls' forces on grains point inward, their levers outward.
  Mat3 inside = sums.pairs.value();
  inside += -1.0 * sums.wall_branches.value();
  result.stress = (1 / space->volume) * inside;
  result.wall_stress = (-1 / space->volume) * sums.on_walls.value();
  result.invariants = invariants(result.stress);
  result.axial_deviator = axial_deviator(axis, result.stress, result.invariants.mean);
  if (result.invariants.mean > 0 && solids > 0) {
    const double diameter = sums.weighted_diameter.value() / solids;
    result.inertial_number = largest_rate(simulation, *space) * diameter *
                             std::sqrt(simulation.setup().density / result.invariants.mean);
  }
  return result;
}

}  // namespace reckon
