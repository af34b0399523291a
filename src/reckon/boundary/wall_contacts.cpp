// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/wall_contacts.hpp"

#include <algorithm>
#include <map>

#include "reckon/contact/pair_kernel.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

double distance(const Wall& wall, const WallPose& pose, const Vec3& point) {
  return std::visit([&](const auto& s) { return s.distance(point - pose.displacement); },
                    wall.surface);
}

/// Every node of the grain, in order, against the wall. A wall's distance has slope one, so a
/// grain whose centre is farther than its bounding radius cannot touch.
void find_touches(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                  std::vector<Touch>& touches) {
  const ShapeView& shape = *grain.shape;
  if (!(distance(wall, pose, grain.position) < shape.bounding_radius)) return;
  std::visit(
      [&](const auto& surface) {
        const Vec3 center = grain.position - pose.displacement;
        for (std::size_t n = 0; n < shape.node_x.size(); ++n) {
          Vec3 lever = grain.rotation * Vec3{shape.node_x[n], shape.node_y[n], shape.node_z[n]};
          const Vec3 point = center + lever;
          const double phi = surface.distance(point);
          if (!(phi < 0)) continue;
          if (wall.shortened_lever) lever *= 1 + phi / norm(lever);
          touches.push_back(
              {static_cast<NodeIndex>(n), phi, surface.gradient(point), lever, shape.node_area[n]});
        }
      },
      wall.surface);
}

WallForce force_of(const DirectedForce& directed, const Vec3& wall_velocity, double time_step) {
  return {directed.force,
          directed.moment_master,
          directed.deepest,
          directed.elastic,
          directed.friction,
          directed.dashpot,
          dot(directed.force, wall_velocity) * time_step,
          directed.touching};
}

}  // namespace

void WallContacts::move_walls(std::uint64_t step, double time_step) {
  poses_.resize(walls_.size());
  for (std::size_t w = 0; w < walls_.size(); ++w) poses_[w] = pose_at(walls_[w], step, time_step);
}

void WallContacts::rebuild(std::span<const GrainFrame> frames, double skin) {
  std::map<std::pair<GrainId, WallId>, SpringRange> kept;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    if (springs_of_candidate_[c].count > 0) {
      kept[{candidates_[c].grain, candidates_[c].wall}] = springs_of_candidate_[c];
    }
  }
  candidates_.clear();
  springs_of_candidate_.clear();
  first_of_slot_.assign(1, 0);
  for (std::uint32_t slot = 0; slot < frames.size(); ++slot) {
    for (std::uint32_t w = 0; w < walls_.size(); ++w) {
      const double reach = frames[slot].shape->bounding_radius + skin;
      if (!(distance(walls_[w], poses_[w], frames[slot].position) < reach)) continue;
      candidates_.push_back({slot, WallId{w}, frames[slot].id});
      const auto found = kept.find({frames[slot].id, WallId{w}});
      springs_of_candidate_.push_back(found != kept.end() ? found->second : SpringRange{});
    }
    first_of_slot_.push_back(static_cast<std::uint32_t>(candidates_.size()));
  }
}

void WallContacts::evaluate(std::span<const GrainFrame> frames, double time_step) {
  forces_.resize(candidates_.size());
  new_springs_of_candidate_.resize(candidates_.size());
  store_.begin_writing(thread_count());
  std::vector<std::vector<Touch>> scratch(static_cast<std::size_t>(thread_count()));
  parallel_for(candidates_.size(), 32, [&](std::size_t c) {
    const GrainFrame& grain = frames[candidates_[c].slot];
    const std::uint32_t w = candidates_[c].wall.get();
    const auto old_springs = store_.read(springs_of_candidate_[c]);
    auto& touches = scratch[static_cast<std::size_t>(thread_index())];
    touches.clear();
    find_touches(grain, walls_[w], poses_[w], touches);
    new_springs_of_candidate_[c] = store_.append([&](std::vector<NodeSpring>& arena) {
      forces_[c] = {};
      if (touches.empty() && old_springs.empty()) return;
      const PairContext context{
          .effective_mass = grain.mass, .friction = walls_[w].friction, .time_step = time_step};
      const RigidMotion grain_motion{grain.position, grain.velocity, grain.angular_velocity_world};
      const RigidMotion wall_motion{grain.position, poses_[w].velocity, {}};
      std::visit(
          [&](const auto& law) {
            forces_[c] =
                force_of(respond(law, context, grain.position, grain_motion, wall_motion, touches,
                                 old_springs, grain.shape->node_area, false, 1, arena),
                         poses_[w].velocity, time_step);
          },
          walls_[w].law);
    });
  });
}

void WallContacts::add_loads(std::span<Load> loads, std::span<EnergyLedger> ledgers) const {
  parallel_for(loads.size(), 256, [&](std::size_t slot) {
    for (std::uint32_t c = first_of_slot_[slot]; c < first_of_slot_[slot + 1]; ++c) {
      const WallForce& wall = forces_[c];
      if (wall.touching > 0) loads[slot] += Load{wall.force, wall.moment};
      if (wall.friction != 0) ledgers[slot].friction += wall.friction;
      if (wall.dashpot != 0) ledgers[slot].dashpot += wall.dashpot;
      if (wall.work != 0) ledgers[slot].wall_work += wall.work;
    }
  });
}

void WallContacts::commit() {
  store_.commit();
  springs_of_candidate_.swap(new_springs_of_candidate_);
}

std::vector<WallSprings> WallContacts::springs() const {
  std::vector<WallSprings> all;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const auto springs = store_.read(springs_of_candidate_[c]);
    if (springs.empty()) continue;
    all.push_back({candidates_[c].grain, candidates_[c].wall, {springs.begin(), springs.end()}});
  }
  std::sort(all.begin(), all.end(), [](const WallSprings& s, const WallSprings& t) {
    return s.grain != t.grain ? s.grain < t.grain : s.wall < t.wall;
  });
  return all;
}

void WallContacts::adopt(std::span<const WallSprings> springs) {
  for (const WallSprings& entry : springs) {
    candidates_.push_back({0, entry.wall, entry.grain});
    springs_of_candidate_.push_back(store_.adopt(entry.springs));
  }
}

}  // namespace reckon
