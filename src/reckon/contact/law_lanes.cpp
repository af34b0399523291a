// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws over lanes. The laws are plain code for one node; the compiler turns the loop over the
// lanes into vectors, once for each set of instructions. Additions, multiplications, divisions and
// roots round alike in all of them, and nothing is fused (cmake/ReckonFlags.cmake). A law becomes
// vectors if it chooses between values (a ? b : c, std::max) instead of paths, each choice by one
// comparison, and keeps structs that it gets from functions in variables that are not const, which
// GCC 12 cannot take apart. A template needs HWY_ATTR to be compiled for its set of instructions.
#define HWY_DISABLED_TARGETS (~(HWY_AVX2 | HWY_AVX3 | HWY_NEON | HWY_EMU128 | HWY_SCALAR))
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reckon/contact/law_lanes.cpp"
#include <hwy/foreach_target.h>  // must come first

#include <hwy/highway.h>

#include <utility>

#include "reckon/contact/node_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace reckon::HWY_NAMESPACE {
namespace {

/// One block. Everything is inlined, so that the loop over lanes has no call.
template <class Law>
HWY_INLINE HWY_ATTR void answer(const Law& law, double friction, double time_step,
                                const LaneTouches& b, const LaneSprings& before,
                                LaneSprings& springs, LaneResponses& responses) {
  // Filled in here first: local objects that nothing else refers to.
  LaneSprings after;
  LaneResponses r;
  for (std::size_t n = 0; n < lane_count; ++n) {
    const Vec3 gradient = b.gradient[n];
    const double steepness = norm(gradient);
    const Vec3 normal = gradient / steepness;
    const PairContext context{.effective_mass = b.effective_mass[n],
                              .friction = friction,
                              .total_area = b.total_area[n],
                              .total_volume = b.total_volume[n],
                              .third_moment = b.third_moment[n],
                              .fourth_moment = b.fourth_moment[n],
                              .touching = b.touching[n],
                              .time_step = time_step};
    const Vec3 lever_master = b.lever_master[n];
    const Touch touch{b.node[n], b.phi[n], gradient, lever_master, b.area[n]};
    Vec3 turned = rotate_between(before.shear_force[n], before.normal[n], normal);
    const bool is_old = squared_norm(before.normal[n]) > 0;  // else zeros, which may have signs
    const ShearSpring spring{{is_old ? turned.x : 0, is_old ? turned.y : 0, is_old ? turned.z : 0},
                             before.shear_stiffness[n]};
    const Vec3 velocity = b.velocity[n];
    NodeForce node = law.node_force(context, touch, normal, velocity, spring);
    r.steepness[n] = steepness;
    r.force.set(n, node.force);
    r.moment_master.set(n, cross(lever_master, node.force));
    r.moment_slave.set(n, cross(b.lever_slave[n], node.force));
    r.elastic[n] = node.elastic;
    r.friction[n] = node.friction;
    r.dashpot[n] =
        dashpot_loss(before.dashpot_push[n], node, touch, dot(normal, velocity), time_step);
    after.normal.set(n, normal);
    after.shear_force.set(n, node.shear_force);
    after.dashpot_push[n] = node.dashpot_push;
    after.shear_stiffness[n] = node.shear_stiffness;
  }
  springs = after;
  responses = r;
}

template <class Law>
HWY_ATTR __attribute__((flatten)) void answer_blocks(const Law& given, double friction,
                                                     double time_step,
                                                     std::span<TouchLanes> blocks) {
  const Law law = given;  // a copy: stores to the blocks cannot change it
  for (TouchLanes& block : blocks) {
    answer(law, friction, time_step, block.touches, block.before, block.after, block.responses);
  }
}

template <class Law>
HWY_ATTR __attribute__((flatten)) void answer_nodes(const Law& given, double friction,
                                                    double time_step, std::size_t now,
                                                    std::span<NodeLanes> lanes,
                                                    std::span<LaneWork> work) {
  const Law law = given;
  for (std::size_t b = 0; b < lanes.size(); ++b) {
    answer(law, friction, time_step, work[b].touches, lanes[b].springs[1 - now],
           lanes[b].springs[now], work[b].responses);
  }
}

void answer_any_blocks(const AnyContactLaw& any, double friction, double time_step,
                       std::span<TouchLanes> blocks) {
  std::visit([&](const auto& law) { answer_blocks(law, friction, time_step, blocks); }, any);
}

void answer_any_nodes(const AnyContactLaw& any, double friction, double time_step, std::size_t now,
                      std::span<NodeLanes> lanes, std::span<LaneWork> work) {
  std::visit([&](const auto& law) { answer_nodes(law, friction, time_step, now, lanes, work); },
             any);
}

}  // namespace

std::pair<LawLanes, LawOfNodes> kernels_of_target() {
  return {answer_any_blocks, answer_any_nodes};
}

}  // namespace reckon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace reckon {

namespace {

std::pair<LawLanes, LawOfNodes> kernels(SimdLevel level) {
  [[maybe_unused]] const SimdLevel resolved = resolve(level);
#if HWY_TARGETS & HWY_AVX2
  if (resolved == SimdLevel::avx2) return N_AVX2::kernels_of_target();
#endif
#if HWY_TARGETS & HWY_AVX3
  if (resolved == SimdLevel::avx512) return N_AVX3::kernels_of_target();
#endif
  return HWY_STATIC_DISPATCH(kernels_of_target)();  // what all machines of this kind have
}

}  // namespace

LawLanes law_lanes(SimdLevel level) { return kernels(level).first; }
LawOfNodes law_of_nodes(SimdLevel level) { return kernels(level).second; }

}  // namespace reckon
#endif
