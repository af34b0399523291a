// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "reckon/contact/grain_contacts.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon {

/// Energies at one step. Stored parts first, then what left or came in since the run began.
struct EnergyBudget {
  double translation{0};  ///< kinetic [J]
  double rotation{0};     ///< kinetic [J]
  double gravity{0};      ///< potential, zero at the origin [J]
  double elastic{0};      ///< in the contacts' springs [J]
  double friction{0};     ///< lost to sliding [J]
  double dashpot{0};      ///< lost to contact dashpots [J]
  double damping{0};      ///< lost to global damping [J]
  double fracture{0};     ///< lost as bonds broke [J]
  double body_work{0};    ///< come in through body forces other than gravity [J]
  double wall_work{0};    ///< come in through moving walls and prescribed grains [J]
  double departed{0};     ///< carried away by grains that left [J]

  /// Stored plus lost minus come in: constant, up to the error of the time stepping [J].
  [[nodiscard]] double total() const {
    return translation + rotation + gravity + elastic + friction + dashpot + damping + fracture +
           departed - body_work - wall_work;
  }
  friend bool operator==(const EnergyBudget&, const EnergyBudget&) = default;
};

/// What a run says of itself at one step. All sums are exact before their one rounding, so they do
/// not depend on the number of threads or ranks.
struct Measurement {
  std::uint64_t step{0};
  double time{0};  ///< [s]
  EnergyBudget energy;
  std::uint64_t grains{0};
  std::uint64_t departed{0};       ///< grains that left through an outflow since the start
  std::uint64_t contacts{0};       ///< touching pairs of grains
  std::uint64_t wall_contacts{0};  ///< touching pairs of grain and wall
  std::uint64_t touching_nodes{0};
  double coordination{0};  ///< contacts per grain, walls included
  /// Mean net force on a grain / mean contact force; infinite where no contact carries a force.
  double unbalanced_ratio{0};
  double carried_share{0};       ///< of the free grains' mass: of grains that a contact pushes
  double kinetic_ratio{0};       ///< kinetic energy of free grains / (elastic + lift by a diameter)
  double deepest_overlap{0};     ///< [m]
  double overlap_ratio{0};       ///< largest overlap / diameter of the smaller grain of the contact
  std::uint64_t outside{0};      ///< free grains whose centre is behind a wall
  double largest_speed{0};       ///< [m/s]
  Vec3 momentum;                 ///< [kg m/s]
  std::vector<Vec3> wall_force;  ///< of the grains on each wall [N]
  double membrane_pressure{0};   ///< [Pa]
  double membrane_stretch{0};    ///< energy in its bonds, part of `elastic` [J]
  std::uint64_t membrane_nodes{0};  ///< of it that touch a grain
  std::uint64_t bonds{0};           ///< that hold
  BrokenBonds broken_bonds;

  friend bool operator==(const Measurement&, const Measurement&) = default;
};

/// At rest, this share of the mass at least lies on something.
constexpr double rest_carried_share = 0.5;

/// Whether the assembly is at rest to this ratio, as far as one step can show. Small net forces
/// alone do not mean rest: grains in flight have some, and the few contacts of a rebound carry no
/// force or a large one. So contacts must carry most of the grains, and the kinetic energy must be
/// below the same ratio of what holds them.
[[nodiscard]] inline bool is_at_rest(const Measurement& m, double ratio) {
  return m.unbalanced_ratio < ratio && m.carried_share >= rest_carried_share &&
         m.kinetic_ratio <= ratio;
}

}  // namespace reckon
