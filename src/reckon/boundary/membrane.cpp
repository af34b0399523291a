// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/membrane.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

/// Puts entries that name a node into the order of nodes, then grains, and says where each node's
/// begin.
template <class Entry, class SpringOf>
void sort_by_node(std::vector<Entry>& entries, std::size_t nodes, std::vector<std::uint32_t>& first,
                  SpringOf&& spring_of) {
  first.assign(nodes + 1, 0);
  for (const Entry& entry : entries) ++first[spring_of(entry).node + 1];
  for (std::size_t n = 0; n < nodes; ++n) first[n + 1] += first[n];
  std::vector<Entry> sorted(entries.size());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (const Entry& entry : entries) sorted[next[spring_of(entry).node]++] = entry;
  for (std::size_t n = 0; n < nodes; ++n) {
    std::sort(
        sorted.begin() + first[n], sorted.begin() + first[n + 1],
        [&](const Entry& a, const Entry& b) { return spring_of(a).grain < spring_of(b).grain; });
  }
  entries = std::move(sorted);
}

const MembraneSpring& same(const MembraneSpring& spring) { return spring; }
const MembraneSpring& spring_in(const MembraneTouch& touch) { return touch.spring; }

}  // namespace

double membrane_bond_stiffness(double modulus_times_thickness) {
  return 0.5 * std::numbers::sqrt3 * modulus_times_thickness;
}

double membrane_areal_mass(const MembraneSetup& setup, double highest_pressure, double time_step,
                           double phase) {
  // Six bonds along and against a node: its row of the stiffness matrix sums to 2 * 6 k at most.
  const double area = 0.5 * std::numbers::sqrt3 * setup.spacing * setup.spacing;
  const double contact =
      std::max(setup.contact.normal_stiffness, setup.contact.shear_stiffness) * area;
  const double stiffness =
      2 * contact + 12 * setup.bond_stiffness + std::abs(highest_pressure) * setup.spacing;
  return stiffness * (time_step / phase) * (time_step / phase) / area;
}

void Membrane::take_place(const CylinderPlace& place, WallId floor, WallId lid,
                          std::span<const WallPose> poses) {
  state_ = {.start = place,
            .floor = floor,
            .lid = lid,
            .floor_start = poses[floor.get()].displacement,
            .lid_start = poses[lid.get()].displacement,
            .nodes = {},
            .springs = {}};
  mesh_ = MembraneMesh{place, setup_.spacing};
  for (const Vec3& p : mesh_.places()) state_.nodes.push_back({p, {}, {}});
  first_spring_.assign(mesh_.size() + 1, 0);
  follow(poses);
  evaluate({}, 0);
  begin_stage(0);
}

void Membrane::adopt(MembraneState state) {
  state_ = std::move(state);
  if (!state_.in_place()) return;
  const double nodes = MembraneMesh::expected_size(state_.start, setup_.spacing);
  const auto found = static_cast<double>(state_.nodes.size());
  // Neither of its lengths alone may ask for more nodes than there are.
  const auto is_sound = [&](double length) {
    return length > 0 && length < (found + 100) * setup_.spacing;
  };
  const bool likely = nodes > 0.5 * found && nodes < 2 * found + 100 &&
                      is_sound(state_.start.radius) && is_sound(state_.start.height);
  if (likely) mesh_ = MembraneMesh{state_.start, setup_.spacing};
  const bool fits = mesh_.size() == state_.nodes.size() &&
                    std::all_of(state_.springs.begin(), state_.springs.end(),
                                [&](const MembraneSpring& s) { return s.node < mesh_.size(); });
  if (!fits) {
    throw Error{{.place = "the state to go on from",
                 .problem = "its membrane has other nodes than that of the scene",
                 .reason = {},
                 .fix = "Go on with the scene that it came from."}};
  }
  sort_by_node(state_.springs, mesh_.size(), first_spring_, same);
}

std::span<const MembraneSpring> Membrane::springs_of(std::uint32_t node) const {
  return std::span{state_.springs}.subspan(first_spring_[node],
                                           first_spring_[node + 1] - first_spring_[node]);
}

void Membrane::follow(std::span<const WallPose> poses) {
  floor_pose_ = poses[state_.floor.get()];
  lid_pose_ = poses[state_.lid.get()];
  const Vec3& axis = state_.start.axis_unit;
  const auto carry = [&](std::uint32_t node, const Vec3& shift, const Vec3& velocity) {
    MembraneNode& carried = state_.nodes[node];
    Vec3 move = mesh_.places()[node] + shift - carried.position;
    Vec3 change = velocity - carried.velocity;
    if (setup_.ends == MembraneEnds::sliding) {
      move = dot(move, axis) * axis;
      change = dot(change, axis) * axis;
    }
    carried.position += move;
    carried.velocity += change;
  };
  const std::uint32_t columns = mesh_.columns();
  const auto last_ring = static_cast<std::uint32_t>(mesh_.size()) - columns;
  for (std::uint32_t column = 0; column < columns; ++column) {
    carry(column, floor_pose_.displacement - state_.floor_start, floor_pose_.velocity);
    carry(last_ring + column, lid_pose_.displacement - state_.lid_start, lid_pose_.velocity);
  }
}

Vec3 Membrane::foot() const {
  return state_.start.foot + (floor_pose_.displacement - state_.floor_start);
}

double Membrane::height() const {
  return state_.start.height + dot((lid_pose_.displacement - state_.lid_start) -
                                       (floor_pose_.displacement - state_.floor_start),
                                   state_.start.axis_unit);
}

std::optional<Membrane::Held> Membrane::held(std::uint32_t node) const {
  if (!mesh_.is_end(node)) return std::nullopt;
  return Held{(node < mesh_.columns() ? floor_pose_ : lid_pose_).velocity,
              setup_.ends == MembraneEnds::sliding};
}

/// Bonds and pressure. The pressure on a triangle goes to its corners in equal parts, which is
/// minus the derivative of pressure times volume.
void Membrane::add_sheet(std::uint32_t node, NodeLoad& sum) const {
  const auto around = mesh_.neighbors(node);
  const Vec3& here = state_.nodes[node].position;
  std::array<Vec3, 6> edges;
  for (std::size_t n = 0; n < 6; ++n) {
    if (around[n] == MembraneMesh::none) continue;
    edges[n] = state_.nodes[around[n]].position - here;
    const bool in_ring = n % 3 == 0;
    const double rest = in_ring ? mesh_.ring_bond() : mesh_.cross_bond();
    const double length_squared = squared_norm(edges[n]);
    if (!(length_squared > rest * rest)) continue;  // slack
    // The strip that a ring bond stands for is cut in half at an end.
    const double stiffness = (in_ring && mesh_.is_end(node) ? 0.5 : 1.0) * setup_.bond_stiffness;
    const double length = std::sqrt(length_squared);
    const double stretch = length - rest;
    sum.total += (stiffness * stretch / length) * edges[n];
    sum.stored += 0.25 * stiffness * stretch * stretch;
  }
  Vec3 outward;  // three times twice the node's share of the area
  for (std::size_t n = 0; n < 6; ++n) {
    const std::size_t next = n == 5 ? 0 : n + 1;
    if (around[n] == MembraneMesh::none || around[next] == MembraneMesh::none) continue;
    outward += cross(edges[n], edges[next]);
  }
  sum.pressure = (-pressure_ / 6) * outward;
  sum.total += sum.pressure;
  sum.volume = dot(here - foot(), outward) / 18;
}

void Membrane::add_contacts(std::uint32_t node, NodeLoad& sum) const {
  const auto springs = springs_of(node);
  auto old = springs.begin();
  const auto let_go = [&] {
    sum.let_go +=
        ShearSpring{old->shear_force, setup_.contact.shear_stiffness * mesh_.area(node)}.stored();
    ++old;
  };
  for (std::uint32_t t = first_touch_[node]; t < first_touch_[node + 1]; ++t) {
    const GrainId grain = touches_[t].spring.grain;
    while (old != springs.end() && old->grain < grain) let_go();
    if (old != springs.end() && old->grain == grain) ++old;
    sum.total += touches_[t].force;
  }
  while (old != springs.end()) let_go();
}

void Membrane::evaluate(std::vector<MembraneTouch> touches, double pressure) {
  pressure_ = pressure;
  touches_ = std::move(touches);
  sort_by_node(touches_, mesh_.size(), first_touch_, spring_in);
  forces_.resize(mesh_.size());
  parallel_for(mesh_.size(), 512, [&](std::size_t n) {
    const auto node = static_cast<std::uint32_t>(n);
    NodeLoad sum;
    add_sheet(node, sum);
    add_contacts(node, sum);
    forces_[n] = sum;
  });
  // Cones over all triangles, from the foot; the floor has the foot in it.
  volume_ = 0;
  for (const NodeLoad& force : forces_) volume_ += force.volume;
  double lid_area = 0;  // twice
  const auto last_ring = static_cast<std::uint32_t>(mesh_.size()) - mesh_.columns();
  const Vec3 middle = foot() + height() * state_.start.axis_unit;
  for (std::uint32_t column = 0; column < mesh_.columns(); ++column) {
    const std::uint32_t next = column + 1 == mesh_.columns() ? 0 : column + 1;
    lid_area += dot(cross(state_.nodes[last_ring + column].position - middle,
                          state_.nodes[last_ring + next].position - middle),
                    state_.start.axis_unit);
  }
  volume_ += lid_area * height() / 6;
}

Vec3 Membrane::velocity_after(std::uint32_t node, double time_step) const {
  const double drag = 0.5 * setup_.damping * time_step;
  const Vec3 free =
      ((1 - drag) * state_.nodes[node].velocity + (time_step / mass(node)) * forces_[node].total) /
      (1 + drag);
  const auto holder = held(node);
  if (!holder) return free;
  if (!holder->within_plane) return holder->velocity;
  const Vec3& axis = state_.start.axis_unit;
  return free + dot(holder->velocity - free, axis) * axis;
}

void Membrane::advance(double time_step) {
  const Vec3& axis = state_.start.axis_unit;
  parallel_for(mesh_.size(), 512, [&](std::size_t n) {
    const auto node = static_cast<std::uint32_t>(n);
    MembraneNode& moving = state_.nodes[n];
    const Vec3 after = velocity_after(node, time_step);
    const NodeLoad& force = forces_[n];
    Vec3 own = 0.5 * (moving.velocity + after);  // at the step
    Vec3 carried;                                // by a plane, which is not its own
    if (const auto holder = held(node)) {
      const bool slides = holder->within_plane;
      carried = slides ? dot(holder->velocity, axis) * axis : holder->velocity;
      own = slides ? own - dot(own, axis) * axis : Vec3{};
    }
    moving.ledger.friction += force.let_go;
    moving.ledger.damping += setup_.damping * time_step * mass(node) * squared_norm(own);
    moving.ledger.wall_work +=
        (dot(force.pressure, own + carried) - dot(force.total, carried)) * time_step;
    moving.velocity = after;
    moving.position += time_step * after;
  });
  state_.springs.clear();
  for (const MembraneTouch& touch : touches_) state_.springs.push_back(touch.spring);
  first_spring_ = first_touch_;
}

void Membrane::begin_stage(double pressure_before) {
  state_.pressure_before = pressure_before;
  state_.volume_at_stage_start = volume_;
  state_.height_at_stage_start = height();
}

double Membrane::kinetic_energy(std::uint32_t node, double time_step) const {
  const auto holder = held(node);
  if (holder && !holder->within_plane) return 0;
  Vec3 mean = 0.5 * (state_.nodes[node].velocity + velocity_after(node, time_step));
  // What follows a plane is not its own.
  const Vec3& axis = state_.start.axis_unit;
  if (holder) mean -= dot(mean, axis) * axis;
  return 0.5 * mass(node) * squared_norm(mean);
}

EnergyLedger Membrane::ledger(std::uint32_t node) const {
  EnergyLedger ledger = state_.nodes[node].ledger;
  ledger.friction += forces_[node].let_go;
  return ledger;
}

bool Membrane::is_finite() const {
  return !(parallel_max(mesh_.size(), 0, [&](std::size_t n) {
             const MembraneNode& node = state_.nodes[n];
             return reckon::is_finite(node.position) && reckon::is_finite(node.velocity) ? 0.0
                                                                                         : 1.0;
           }) > 0);
}

Enclosure Membrane::enclosure_of(double volume, double height, const Vec3& foot,
                                 std::size_t wall_count) const {
  const double area = volume / height;
  const double radius = std::sqrt(std::max(area, 0.0) / std::numbers::pi);
  const Vec3& axis = state_.start.axis_unit;
  Enclosure space{volume, {}, {}, std::vector<double>(wall_count, 0)};
  space.areas[state_.floor.get()] = space.areas[state_.lid.get()] = area;
  for (int a = 0; a < 3; ++a) {
    const double rim = radius * std::sqrt(std::max(0.0, 1 - axis[a] * axis[a]));
    const double end = foot[a];
    const double other_end = foot[a] + height * axis[a];
    space.low[a] = std::min(end, other_end) - rim;
    space.high[a] = std::max(end, other_end) + rim;
  }
  return space;
}

Enclosure Membrane::enclosure(std::size_t wall_count) const {
  return enclosure_of(volume_, height(), foot(), wall_count);
}

Enclosure Membrane::enclosure_at_stage_start(std::size_t wall_count) const {
  return enclosure_of(state_.volume_at_stage_start, state_.height_at_stage_start, state_.start.foot,
                      wall_count);
}

}  // namespace reckon
