// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "reckon/core/id.hpp"
#include "reckon/math/rotation.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon {

/// Where a grain's energy went, added up since the run began.
struct EnergyLedger {
  double friction{0};   ///< lost to sliding at its contacts [J]
  double dashpot{0};    ///< lost to contact dashpots [J]
  double damping{0};    ///< lost to global damping [J]
  double body_work{0};  ///< done on it by body forces other than gravity [J]
  double wall_work{0};  ///< done on it by moving walls [J]
  double fracture{0};   ///< lost as its bonds broke [J]

  EnergyLedger& operator+=(const EnergyLedger& b) {
    friction += b.friction;
    dashpot += b.dashpot;
    damping += b.damping;
    body_work += b.body_work;
    wall_work += b.wall_work;
    fracture += b.fracture;
    return *this;
  }
  friend bool operator==(const EnergyLedger&, const EnergyLedger&) = default;
};

/// The whole state of one grain, as it migrates and as a checkpoint holds it.
struct GrainState {
  GrainId id;
  ShapeId shape;
  bool prescribed{false};       ///< keeps its velocities, independent of forces
  Vec3 position;                ///< centre of mass, at the step [m]
  Quaternion orientation;       ///< body to world, at the step
  Vec3 velocity;                ///< half a step before [m/s]
  Vec3 angular_velocity_body;   ///< half a step before [rad/s]
  Vec3 angular_increment_body;  ///< change of the angular velocity in the last step [rad/s]
  EnergyLedger ledger;

  friend bool operator==(const GrainState&, const GrainState&) = default;
};

/// The moving state of all grains of a process, one array per quantity. A place in the arrays (a
/// slot) means nothing outside the process: ids name grains.
struct Grains {
  std::vector<GrainId> id;
  std::vector<ShapeId> shape;
  std::vector<std::uint8_t> prescribed;
  std::vector<Vec3> position;
  std::vector<Quaternion> orientation;
  std::vector<Vec3> velocity;
  std::vector<Vec3> angular_velocity_body;
  std::vector<Vec3> angular_increment_body;
  std::vector<EnergyLedger> ledger;

  [[nodiscard]] std::size_t size() const { return id.size(); }

  void push_back(const GrainState& grain) {
    id.push_back(grain.id);
    shape.push_back(grain.shape);
    prescribed.push_back(grain.prescribed ? 1 : 0);
    position.push_back(grain.position);
    orientation.push_back(grain.orientation);
    velocity.push_back(grain.velocity);
    angular_velocity_body.push_back(grain.angular_velocity_body);
    angular_increment_body.push_back(grain.angular_increment_body);
    ledger.push_back(grain.ledger);
  }

  [[nodiscard]] GrainState state(std::size_t slot) const {
    return {id[slot],
            shape[slot],
            prescribed[slot] != 0,
            position[slot],
            orientation[slot],
            velocity[slot],
            angular_velocity_body[slot],
            angular_increment_body[slot],
            ledger[slot]};
  }
};

/// Force and moment on one grain, summed contact by contact in a fixed order.
struct Load {
  Vec3 force;   ///< world frame [N]
  Vec3 moment;  ///< about the centre of mass, world frame [N m]

  Load& operator+=(const Load& b) {
    force += b.force;
    moment += b.moment;
    return *this;
  }
};

}  // namespace reckon
