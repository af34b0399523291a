// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/wall_contacts.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "reckon/contact/near_skin.hpp"
#include "reckon/contact/pair_kernel.hpp"
#include "reckon/contact/visit_due.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

/// A wall moves alike everywhere, so its centre may lie anywhere.
RigidMotion motion_of(const WallPose& wall, const GrainFrame& grain) {
  return {grain.position, wall.velocity, {}};
}

/// How deep a grain that touches is in a wall [m]: a sphere as deep as it is, whatever its nodes
/// say; else as deep as its deepest node.
double overlap_of(const GrainFrame& grain, const Wall& wall, const WallPose& pose,
                  const DirectedForce& directed) {
  const double radius = grain.shape->sphere_radius;
  if (!(radius > 0) || directed.touching == 0) return directed.deepest;
  return radius - distance(wall, pose, grain.position);
}

WallForce force_of(const DirectedForce& directed, double overlap, const Mat3& first_moment,
                   const Vec3& wall_velocity, double time_step) {
  return {directed.force,
          directed.moment_master,
          overlap,
          directed.elastic,
          directed.friction,
          directed.dashpot,
          dot(directed.force, wall_velocity) * time_step,
          directed.stiffness,
          directed.damping,
          first_moment,
          directed.touching};
}

}  // namespace

void WallContacts::set_friction(std::span<const double> friction) {
  for (std::size_t w = 0; w < walls_.size(); ++w) walls_[w].friction = friction[w];
}

void WallContacts::rebuild(std::span<const GrainFrame> frames, const AdaptiveSkin& skin) {
  std::map<std::pair<GrainId, WallId>, std::size_t> old_place;
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    old_place[{candidates_[c].grain, candidates_[c].wall}] = c;
  }
  const auto old_springs = std::exchange(springs_of_candidate_, {});
  const auto old_next_check = std::exchange(next_check_, {});
  auto old_near = std::exchange(near_, {});
  candidates_.clear();
  first_of_slot_.assign(1, 0);
  for (std::uint32_t slot = 0; slot < frames.size(); ++slot) {
    for (std::uint32_t w = 0; w < walls_.size(); ++w) {
      if (removed_[w]) continue;
      const double reach = frames[slot].shape->bounding_radius +
                           skin.of(frames[slot].velocity, frames[slot].position) +
                           skin.of(poses_[w].velocity);
      if (!(distance(walls_[w], poses_[w], frames[slot].position) < reach)) continue;
      candidates_.push_back({slot, WallId{w}, frames[slot].id});
      const auto found = old_place.find({frames[slot].id, WallId{w}});
      const bool known = found != old_place.end();
      springs_of_candidate_.push_back(known ? old_springs[found->second] : SpringRange{});
      next_check_.push_back(known ? old_next_check[found->second] : check_always);
      near_.push_back(known ? std::move(old_near[found->second]) : NearWall{});
    }
    first_of_slot_.push_back(static_cast<std::uint32_t>(candidates_.size()));
  }
  // A candidate that is skipped writes neither.
  new_springs_of_candidate_.assign(candidates_.size(), {});
  forces_.assign(candidates_.size(), {});
}

void WallContacts::follow_walls() {
  seen_displacement_.resize(walls_.size());
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    path_lengths_[w] += norm(poses_[w].displacement - seen_displacement_[w]);
    path_lengths_[w] *= 1 + 4 * std::numeric_limits<double>::epsilon();
    seen_displacement_[w] = poses_[w].displacement;
  }
}

PairContext WallContacts::context_of(std::size_t c, const GrainFrame& grain,
                                     double time_step) const {
  return {.effective_mass = grain.mass,
          .friction = walls_[candidates_[c].wall.get()].friction,
          .time_step = time_step};
}

/// As in GrainContacts: both spring buffers must be empty before a candidate may be skipped.
void WallContacts::settle(std::size_t c, double next_check, bool had_springs,
                          ContactCounters& counters) {
  next_check_[c] = had_springs ? check_always : next_check;
  ++counters.due;
  counters.touching_nodes += forces_[c].touching;
  if (forces_[c].touching > 0) ++counters.touching_pairs;
}

/// Tests every node and answers one after the other: the oracle.
void WallContacts::evaluate_plainly(std::size_t c, const GrainFrame& grain, double time_step,
                                    Scratch& scratch) {
  const Wall& wall = walls_[candidates_[c].wall.get()];
  const WallPose& pose = poses_[candidates_[c].wall.get()];
  const auto old_springs = store_.read(springs_of_candidate_[c]);
  scratch.touches.clear();
  find_wall_touches(grain, wall, pose, scratch.touches);
  const PairContext context = context_of(c, grain, time_step);
  new_springs_of_candidate_[c] = store_.append([&](std::vector<NodeSpring>& arena) {
    std::visit(
        [&](const auto& law) {
          Mat3 first_moment;
          const DirectedForce directed =
              pair_force(law, context, grain.position, motion_of(grain), motion_of(pose, grain),
                         scratch.touches, old_springs, false, 1, arena, &first_moment);
          forces_[c] = force_of(directed, overlap_of(grain, wall, pose, directed), first_moment,
                                pose.velocity, time_step);
        },
        wall.law);
  });
  settle(c, check_always, !old_springs.empty(), scratch.counters);
}

/// Finds the touching nodes of a candidate by its near list and lets them wait for their law.
void WallContacts::find_nodes(std::size_t c, const GrainFrame& grain, double time_step,
                              double path_length, Scratch& scratch) {
  const std::uint32_t w = candidates_[c].wall.get();
  const auto old_springs = store_.read(springs_of_candidate_[c]);
  scratch.touches.clear();
  const double next_check = near_[c].find_touches(grain, walls_[w], poses_[w], path_length,
                                                  scratch.touches, scratch.counters);
  const std::size_t member =
      scratch.batches[w].add(context_of(c, grain, time_step), grain.position, motion_of(grain),
                             motion_of(poses_[w], grain), scratch.touches, old_springs);
  scratch.waiting.push_back({c, member, next_check});
}

/// The forces of the candidates that wait.
void WallContacts::answer_waiting(std::span<const GrainFrame> frames, double time_step,
                                  Scratch& scratch) {
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    scratch.batches[w].evaluate(walls_[w].law, walls_[w].friction, time_step, lanes_);
  }
  for (const Waiting& waiting : scratch.waiting) {
    const std::size_t c = waiting.candidate;
    const std::uint32_t w = candidates_[c].wall.get();
    const auto old_springs = store_.read(springs_of_candidate_[c]);
    new_springs_of_candidate_[c] = store_.append([&](std::vector<NodeSpring>& arena) {
      std::visit(
          [&](const auto& law) {
            Mat3 first_moment;
            const DirectedForce directed = scratch.batches[w].sum(waiting.member, law, old_springs,
                                                                  false, 1, arena, &first_moment);
            const double overlap =
                overlap_of(frames[candidates_[c].slot], walls_[w], poses_[w], directed);
            forces_[c] = force_of(directed, overlap, first_moment, poses_[w].velocity, time_step);
          },
          walls_[w].law);
    });
    settle(c, waiting.next_check, !old_springs.empty(), scratch.counters);
  }
  scratch.waiting.clear();
  for (TouchBatch& batch : scratch.batches) batch.clear();
}

void WallContacts::evaluate(std::span<const GrainFrame> frames,
                            const DisplacementBound& displacements, double time_step) {
  follow_walls();
  const bool use_near_lists = engine_ == ContactEngine::near && displacements.trustworthy();
  if (!use_near_lists) {
    std::fill(next_check_.begin(), next_check_.end(), check_always);
    for (NearWall& list : near_) list = {};
  }
  store_.begin_writing(thread_count());
  scratch_.resize(static_cast<std::size_t>(thread_count()));
  for (Scratch& scratch : scratch_) scratch.batches.resize(walls_.size());
  const auto scratch = [&]() -> Scratch& {
    return scratch_[static_cast<std::size_t>(thread_index())];
  };
  if (use_near_lists) {
    visit_due(
        next_check_, [](std::size_t) { return true; },
        [&](std::size_t c) {
          return displacements.path_lengths()[candidates_[c].slot] +
                 path_lengths_[candidates_[c].wall.get()];
        },
        [&](std::size_t c) {
          near_[c].prefetch();
          prefetch_frame(frames[candidates_[c].slot]);
        },
        [&](std::size_t c, double path_length) {
          find_nodes(c, frames[candidates_[c].slot], time_step, path_length, scratch());
        },
        [&] { answer_waiting(frames, time_step, scratch()); });
  } else {
    parallel_for(candidates_.size(), 32, [&](std::size_t c) {
      evaluate_plainly(c, frames[candidates_[c].slot], time_step, scratch());
    });
  }
  ++counters_.evaluations;
  counters_.pairs += candidates_.size();
  for (Scratch& mine : scratch_) counters_ += std::exchange(mine.counters, {});
}

void WallContacts::add_load(std::size_t slot, Load& load, EnergyLedger& ledger) const {
  for (std::uint32_t c = first_of_slot_[slot]; c < first_of_slot_[slot + 1]; ++c) {
    const WallForce& wall = forces_[c];
    if (wall.touching > 0) load += Load{wall.force, wall.moment};
    if (wall.friction != 0) ledger.friction += wall.friction;
    if (wall.dashpot != 0) ledger.dashpot += wall.dashpot;
    if (wall.work != 0) ledger.wall_work += wall.work;
  }
}

void WallContacts::commit() {
  store_.commit();
  springs_of_candidate_.swap(new_springs_of_candidate_);
}

std::size_t WallContacts::bytes() const {
  const auto of = [](const auto& values) { return values.capacity() * sizeof(values[0]); };
  std::size_t sum = of(candidates_) + of(first_of_slot_) + of(springs_of_candidate_) +
                    of(new_springs_of_candidate_) + of(forces_) + of(next_check_) + of(near_) +
                    store_.bytes();
  for (const NearWall& list : near_) sum += list.bytes();
  return sum;
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
  next_check_.resize(candidates_.size(), check_always);
  near_.resize(candidates_.size());
}

}  // namespace reckon
