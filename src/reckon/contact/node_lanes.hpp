// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "reckon/contact/contact_settings.hpp"
#include "reckon/contact/simd_level.hpp"
#include "reckon/contact/spring_store.hpp"
#include "reckon/core/id.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon {

// Touching nodes side by side, one array per quantity, so that a loop over the lanes becomes
// vectors.

inline constexpr std::size_t lane_count = 8;
using LaneNumbers = std::array<double, lane_count>;
struct LaneVectors {
  LaneNumbers x, y, z;

  [[nodiscard]] Vec3 operator[](std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
  void set(std::size_t lane, const Vec3& v) {
    x[lane] = v.x;
    y[lane] = v.y;
    z[lane] = v.z;
  }
};

/// The springs of touching nodes: see NodeSpring. All zero where there is none.
struct alignas(64) LaneSprings {
  LaneVectors shear_force, normal;
  LaneNumbers dashpot_push, shear_stiffness;

  [[nodiscard]] bool exists(std::size_t lane) const { return squared_norm(normal[lane]) > 0; }
  [[nodiscard]] ShearSpring spring(std::size_t lane) const {
    return {shear_force[lane], shear_stiffness[lane]};
  }
  void set(std::size_t lane, const NodeSpring& spring) {
    shear_force.set(lane, spring.shear_force);
    normal.set(lane, spring.normal);
    dashpot_push[lane] = spring.dashpot_push;
    shear_stiffness[lane] = spring.shear_stiffness;
  }
  [[nodiscard]] NodeSpring get(std::size_t lane, NodeIndex node, bool master_is_b) const {
    return {node,         master_is_b,        shear_force[lane],
            normal[lane], dashpot_push[lane], shear_stiffness[lane]};
  }
};

/// What a law is asked at each node: see Touch, PairContext and ContactLaw.
struct alignas(64) LaneTouches {
  LaneNumbers phi, area, effective_mass, total_area, total_volume, third_moment, fourth_moment;
  LaneVectors gradient, velocity, lever_master, lever_slave;
  std::array<NodeIndex, lane_count> node;
  std::array<std::uint32_t, lane_count> touching;  // nodes of the pair
};

/// What a law answers, besides the new springs.
struct alignas(64) LaneResponses {
  LaneNumbers steepness;  // of the distance
  LaneVectors force, moment_master, moment_slave;
  LaneNumbers elastic, friction, dashpot;
};

/// Touching nodes that are filled in anew at every step.
struct TouchLanes {
  static constexpr std::size_t width = lane_count;
  LaneTouches touches;
  LaneSprings before, after;
  LaneResponses responses;
};

/// Answers all lanes of all blocks: the bits of pair_force() at every node.
using LawLanes = void (*)(const AnyContactLaw& law, double friction, double time_step,
                          std::span<TouchLanes> blocks);
[[nodiscard]] LawLanes law_lanes(SimdLevel level);

}  // namespace reckon
