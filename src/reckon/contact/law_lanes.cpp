// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Laws over TouchLanes. The laws are plain code for one node; the compiler turns the loop over the
// lanes into vectors, once for each set of instructions. Additions, multiplications, divisions and
// roots round alike in all of them, and nothing is fused (cmake/ReckonFlags.cmake). A law becomes
// vectors if it chooses between values (a ? b : c, std::max) instead of paths, and keeps structs
// that it gets from functions in variables that are not const, which GCC 12 cannot take apart.
#define HWY_DISABLED_TARGETS (~(HWY_AVX2 | HWY_AVX3 | HWY_NEON | HWY_EMU128 | HWY_SCALAR))
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reckon/contact/law_lanes.cpp"
#include <hwy/foreach_target.h>  // must come first

#include <hwy/highway.h>

#include "reckon/contact/touch_batch.hpp"

HWY_BEFORE_NAMESPACE();
namespace reckon::HWY_NAMESPACE {
namespace {

/// A law over all blocks. Everything is inlined, so that the loop over lanes has no call.
template <class Law>
__attribute__((flatten)) void answer(const Law& given, double friction, double time_step,
                                     std::span<TouchLanes> blocks) {
  const Law law = given;  // a copy: stores to the blocks cannot change it
  for (TouchLanes& b : blocks) {
    for (std::size_t n = 0; n < TouchLanes::width; ++n) {
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
      Vec3 turned = rotate_between(b.old_spring[n], b.old_normal[n], normal);
      const bool is_old = squared_norm(b.old_normal[n]) > 0;  // else zeros, which may have signs
      const ShearSpring spring{
          {is_old ? turned.x : 0, is_old ? turned.y : 0, is_old ? turned.z : 0},
          b.old_shear_stiffness[n]};
      const Vec3 velocity = b.velocity[n];
      NodeForce node = law.node_force(context, touch, normal, velocity, spring);
      b.steepness[n] = steepness;
      b.normal.set(n, normal);
      b.force.set(n, node.force);
      b.shear_force.set(n, node.shear_force);
      b.moment_master.set(n, cross(lever_master, node.force));
      b.moment_slave.set(n, cross(b.lever_slave[n], node.force));
      b.elastic[n] = node.elastic;
      b.friction[n] = node.friction;
      b.dashpot_push[n] = node.dashpot_push;
      b.shear_stiffness[n] = node.shear_stiffness;
      b.dashpot[n] =
          dashpot_loss(b.old_dashpot_push[n], node, touch, dot(normal, velocity), time_step);
    }
  }
}

struct Answer {
  double friction;
  double time_step;
  std::span<TouchLanes> blocks;

  template <class Law>
  void operator()(const Law& law) const {
    answer(law, friction, time_step, blocks);
  }
};

void answer_any(const AnyContactLaw& law, double friction, double time_step,
                std::span<TouchLanes> blocks) {
  std::visit(Answer{friction, time_step, blocks}, law);
}

}  // namespace

LawLanes lanes_of_target() { return answer_any; }

}  // namespace reckon::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace reckon {

LawLanes law_lanes(SimdLevel level) {
  [[maybe_unused]] const SimdLevel resolved = resolve(level);
#if HWY_TARGETS & HWY_AVX2
  if (resolved == SimdLevel::avx2) return N_AVX2::lanes_of_target();
#endif
#if HWY_TARGETS & HWY_AVX3
  if (resolved == SimdLevel::avx512) return N_AVX3::lanes_of_target();
#endif
  return HWY_STATIC_DISPATCH(lanes_of_target)();  // what all machines of this kind have
}

}  // namespace reckon
#endif
