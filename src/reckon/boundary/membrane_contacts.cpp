// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/membrane_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "reckon/contact/pair_kernel.hpp"
#include "reckon/contact/verlet_node_list.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

/// How far grains and nodes may each go before lists are made anew, in spacings.
constexpr double half_skin_in_spacings = 0.25;

/// Nodes sorted into cubes.
class NodeBins {
 public:
  NodeBins(std::span<const MembraneNode> nodes, double edge) : edge_{edge} {
    low_ = high_ = nodes.front().position;
    for (const MembraneNode& node : nodes) {
      for (int axis = 0; axis < 3; ++axis) {
        low_[axis] = std::min(low_[axis], node.position[axis]);
        high_[axis] = std::max(high_[axis], node.position[axis]);
      }
    }
    constexpr double most_cells = 256;
    for (int axis = 0; axis < 3; ++axis) {
      edge_ = std::max(edge_, (high_[axis] - low_[axis]) / most_cells);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells_[axis] = cell(high_, static_cast<int>(axis)) + 1;
    }
    first_.assign(cells_[0] * cells_[1] * cells_[2] + 1, 0);
    for (const MembraneNode& node : nodes) ++first_[place(node.position) + 1];
    for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
    nodes_.resize(nodes.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t n = 0; n < nodes.size(); ++n) nodes_[next[place(nodes[n].position)]++] = n;
  }

  /// Calls take(node) for all nodes of the cubes that a sphere meets, and some others.
  template <class Take>
  void around(const Vec3& center, double radius, Take&& take) const {
    std::array<std::size_t, 3> from{};
    std::array<std::size_t, 3> to{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      if (center[axis] + radius < low_[axis] || center[axis] - radius > high_[axis]) return;
      const Vec3 lowest{center.x - radius, center.y - radius, center.z - radius};
      const Vec3 highest{center.x + radius, center.y + radius, center.z + radius};
      from[a] = cell(lowest, axis);
      to[a] = std::min(cell(highest, axis), cells_[a] - 1);
    }
    for (std::size_t k = from[2]; k <= to[2]; ++k) {
      for (std::size_t j = from[1]; j <= to[1]; ++j) {
        const std::size_t row = (k * cells_[1] + j) * cells_[0];
        for (std::uint32_t n = first_[row + from[0]]; n < first_[row + to[0] + 1]; ++n) {
          take(nodes_[n]);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::size_t cell(const Vec3& p, int axis) const {
    return static_cast<std::size_t>(std::max((p[axis] - low_[axis]) / edge_, 0.0));
  }
  [[nodiscard]] std::size_t place(const Vec3& p) const {
    return (cell(p, 2) * cells_[1] + cell(p, 1)) * cells_[0] + cell(p, 0);
  }

  double edge_;
  Vec3 low_;
  Vec3 high_;
  std::array<std::size_t, 3> cells_{};
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> nodes_;
};

/// How far a point lies beyond a grid, from below [m].
double distance_to(const LevelSetView& grid, const Vec3& point_body) {
  double farthest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = grid.origin_body[axis];
    const double high = low + grid.spacing * (grid.dims[static_cast<std::size_t>(axis)] - 1);
    farthest = std::max({farthest, low - point_body[axis], point_body[axis] - high});
  }
  return farthest;
}

/// Where a node is in a grain: touching, or at least so far from everything that could touch.
struct Look {
  double clearance;  // [m]
  double phi;        // below zero where the node touches [m]
  Vec3 gradient_world;
};

Look look(const GrainFrame& grain, const Vec3& lever) {
  const ShapeView& shape = *grain.shape;
  const double distance_squared = squared_norm(lever);
  if (!(distance_squared < shape.bounding_radius * shape.bounding_radius)) {
    return {std::sqrt(distance_squared) - shape.bounding_radius, 0, {}};
  }
  const Vec3 place_body = transposed_times(grain.rotation, lever);
  const auto sample = shape.level_set.sample(place_body);
  if (!sample.inside_grid) return {distance_to(shape.level_set, place_body), 0, {}};
  if (!(sample.phi < 0)) return {sample.phi / shape.lipschitz, sample.phi, {}};
  return {0, sample.phi, grain.rotation * sample.gradient_body};
}

}  // namespace

bool MembraneContacts::lists_serve(const Membrane& membrane, std::span<const GrainFrame> frames) {
  const std::span<const MembraneNode> nodes = membrane.nodes();
  if (listed_grains_.size() != frames.size() || listed_nodes_.size() != nodes.size()) return false;
  const double half_skin = half_skin_in_spacings * membrane.setup().spacing;
  const auto is_far = [&](const Vec3& from, const Vec3& to) {
    return squared_norm(to - from) < half_skin * half_skin ? 0.0 : 1.0;  // not a number: far
  };
  const double grain_is_far = parallel_max(frames.size(), 0, [&](std::size_t s) {
    return is_far(listed_grains_[s], frames[s].position);
  });
  if (grain_is_far > 0) return false;
  return !(parallel_max(nodes.size(), 0, [&](std::size_t n) {
             return is_far(listed_nodes_[n], nodes[n].position);
           }) > 0);
}

void MembraneContacts::make_lists(const Membrane& membrane, std::span<const GrainFrame> frames) {
  const std::span<const MembraneNode> nodes = membrane.nodes();
  const double skin = 2 * half_skin_in_spacings * membrane.setup().spacing;
  double largest = 0;
  for (const GrainFrame& frame : frames) largest = std::max(largest, frame.shape->bounding_radius);
  candidates_.clear();
  nodes_.clear();
  listed_grains_.clear();
  listed_nodes_.clear();
  for (const MembraneNode& node : nodes) listed_nodes_.push_back(node.position);
  for (const GrainFrame& frame : frames) listed_grains_.push_back(frame.position);
  seen_nodes_ = listed_nodes_;
  node_path_lengths_.assign(nodes.size(), 0);
  const NodeBins bins{nodes, largest + skin};
  for (std::uint32_t slot = 0; slot < frames.size(); ++slot) {
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    const double reach = frames[slot].shape->bounding_radius + skin;
    bins.around(frames[slot].position, reach, [&](std::uint32_t node) {
      const double distance_squared = squared_norm(nodes[node].position - frames[slot].position);
      if (distance_squared < reach * reach) nodes_.push_back({node, check_always});
    });
    const auto count = static_cast<std::uint32_t>(nodes_.size()) - first;
    if (count == 0) continue;
    std::sort(nodes_.begin() + first, nodes_.end(),
              [](const Near& a, const Near& b) { return a.node < b.node; });
    candidates_.push_back({slot, first, count});
  }
  forces_.resize(candidates_.size());
  ++lists_made_;
}

void MembraneContacts::evaluate_candidate(std::size_t c, const Membrane& membrane,
                                          const GrainFrame& grain, bool may_skip, double travelled,
                                          double time_step, Scratch& scratch) {
  const double margin = 1e-6 * membrane.setup().spacing;  // far above any rounding
  std::vector<Touch>& found = scratch.found;
  found.clear();
  const Candidate& candidate = candidates_[c];
  for (std::uint32_t n = candidate.first; n < candidate.first + candidate.count; ++n) {
    Near& near = nodes_[n];
    const double path_length = travelled + node_path_lengths_[near.node];
    if (may_skip && path_length < near.next_check) continue;
    const Vec3 lever = membrane.nodes()[near.node].position - grain.position;
    const Look at = look(grain, lever);
    near.next_check = may_skip ? path_length + std::max(at.clearance - margin, 0.0) : check_always;
    if (!(at.phi < 0)) continue;
    found.push_back({near.node, at.phi, at.gradient_world, lever, membrane.mesh().area(near.node)});
  }

  MembraneForce& sum = forces_[c];
  sum = {.slot = candidate.slot};
  if (found.empty()) return;
  PairContext context{
      .effective_mass = grain.mass, .friction = membrane.setup().friction, .time_step = time_step};
  count_touches(context, found);
  const double sphere_radius = grain.shape->sphere_radius;
  for (const Touch& touch : found) {
    const double steepness = norm(touch.gradient_world);
    if (!(steepness > 0)) continue;  // a flat spot of the distance has no normal
    const Vec3 normal = touch.gradient_world / steepness;
    ShearSpring spring;  // its stiffness never changes
    double dashpot_before = 0;
    for (const MembraneSpring& old : membrane.springs_of(touch.node)) {
      if (old.grain != grain.id) continue;
      spring.force = rotate_between(old.shear_force, old.normal, normal);
      dashpot_before = old.dashpot_push;
    }
    const Vec3 velocity = membrane.nodes()[touch.node].velocity - grain.velocity -
                          cross(grain.angular_velocity_world, touch.lever_world);
    const NodeForce node =
        membrane.setup().contact.node_force(context, touch, normal, velocity, spring);
    scratch.touches.push_back(
        {{touch.node, grain.id, node.shear_force, normal, node.dashpot_push}, node.force});
    sum.force -= node.force;
    sum.moment -= cross(touch.lever_world, node.force);
    sum.first_moment += outer(-node.force, touch.lever_world);
    sum.place +=
        (touch.area * touch.phi / -context.total_volume) * (grain.position + touch.lever_world);
    sum.deepest = std::max(
        sum.deepest, sphere_radius > 0 ? sphere_radius - norm(touch.lever_world) : -touch.phi);
    sum.elastic += node.elastic;
    sum.friction += node.friction;
    sum.dashpot += dashpot_loss(dashpot_before, node, touch, dot(normal, velocity), time_step);
    ++sum.touching;
  }
}

void MembraneContacts::evaluate(const Membrane& membrane, std::span<const GrainFrame> frames,
                                const DisplacementBound& displacements, double time_step) {
  if (frames.empty()) {
    candidates_.clear();
    forces_.clear();
    scratch_.clear();
    return;
  }
  if (!lists_serve(membrane, frames)) make_lists(membrane, frames);
  const std::span<const MembraneNode> nodes = membrane.nodes();
  parallel_for(nodes.size(), 1024, [&](std::size_t n) {
    const double moved = norm(nodes[n].position - seen_nodes_[n]);
    node_path_lengths_[n] = (node_path_lengths_[n] + moved) * (1 + 1e-14);
    seen_nodes_[n] = nodes[n].position;
  });
  const bool may_skip = engine_ == ContactEngine::near && displacements.trustworthy();
  scratch_.resize(static_cast<std::size_t>(thread_count()));
  for (Scratch& scratch : scratch_) scratch.touches.clear();
  parallel_for(candidates_.size(), 16, [&](std::size_t c) {
    const std::uint32_t slot = candidates_[c].slot;
    evaluate_candidate(c, membrane, frames[slot], may_skip,
                       may_skip ? displacements.path_lengths()[slot] : 0, time_step,
                       scratch_[static_cast<std::size_t>(thread_index())]);
  });
}

std::vector<MembraneTouch> MembraneContacts::touches() const {
  std::vector<MembraneTouch> all;
  for (const Scratch& scratch : scratch_) {
    all.insert(all.end(), scratch.touches.begin(), scratch.touches.end());
  }
  return all;
}

void MembraneContacts::add_load(std::size_t slot, Load& load, EnergyLedger& ledger) const {
  const auto force = std::lower_bound(
      forces_.begin(), forces_.end(), slot,
      [](const MembraneForce& of, std::size_t wanted) { return of.slot < wanted; });
  if (force == forces_.end() || force->slot != slot || force->touching == 0) return;
  load += Load{force->force, force->moment};
  ledger.friction += force->friction;
  ledger.dashpot += force->dashpot;
}

}  // namespace reckon
