// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "reckon/contact/contact_settings.hpp"
#include "reckon/contact/simd_level.hpp"
#include "reckon/contact/spring_store.hpp"
#include "reckon/core/id.hpp"
#include "reckon/grains/grain_frame.hpp"
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

/// Touching nodes that keep their lanes for as long as they touch. What changes only with the cell
/// of the slave's grid, and the springs, stay here from step to step.
struct alignas(64) NodeLanes {
  LaneVectors place_body;                 // in the master [m]
  LaneNumbers area;                       // [m^2]
  std::array<LaneNumbers, 8> polynomial;  // of the cell: CellPolynomial
  LaneVectors cell;                       // of the slave's grid; NaN: none
  LaneVectors grid_origin;                // of the slave, body frame [m]
  LaneNumbers inverse_spacing;            // likewise [1/m]
  LaneNumbers radius_squared;             // bounding, of the slave [m^2]
  LaneNumbers both_radii_squared;         // of the sum of both bounding radii [m^2]
  std::array<LaneSprings, 2> springs;     // of the last step, and of this one, in turns
  std::array<std::uint32_t, lane_count> master, slave;  // slots
  std::array<NodeIndex, lane_count> node;
  std::array<std::uint32_t, lane_count> list;  // twice the pair, plus one if b is the master

  static constexpr double no_cell = std::numeric_limits<double>::quiet_NaN();
};

/// What is computed for NodeLanes at each step.
struct LaneWork {
  LaneTouches touches;
  LaneResponses responses;
  LaneNumbers fits;  // 1: the node is in the cell that its lane holds, and it touches; else 0
};

/// Which image of grain b a pair meets.
struct PairImage {
  bool is_shifted{false};
  Vec3 shift;     ///< [m]
  Vec3 velocity;  ///< of the image against b [m/s]
};

/// Places the nodes in the grids of their slaves and fills in `touches` as far as one node alone
/// determines them; where a lane does not fit, its numbers mean nothing. `images` is null, or has
/// one entry per pair.
using PlaceLanes = void (*)(std::span<const GrainFrame> frames, const PairImage* images,
                            std::span<const NodeLanes> lanes, std::span<LaneWork> work);
[[nodiscard]] PlaceLanes place_lanes(SimdLevel level);

/// The law at all nodes. `now` is 0 or 1: which of the springs are written.
using LawOfNodes = void (*)(const AnyContactLaw& law, double friction, double time_step,
                            std::size_t now, std::span<NodeLanes> lanes, std::span<LaneWork> work);
[[nodiscard]] LawOfNodes law_of_nodes(SimdLevel level);

}  // namespace reckon
