// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "reckon/boundary/wall_control.hpp"
#include "reckon/grains/periodic_cell.hpp"

namespace reckon {

/// Which part of a cell's velocity gradient a control sets: of the edges along the axes, or of
/// simple shear, where planes across the second axis slide along the first.
enum class CellAxis { x, y, z, xy, xz, yz };
[[nodiscard]] constexpr bool is_shear(CellAxis axis) { return axis >= CellAxis::xy; }

/// Drives one component of the deformation of a periodic cell; what no control drives stands still.
///
/// A stress is held by a servo, as a wall's (WallControl). A rate of strain e (compression
/// positive) along an axis, which every grain follows at once, changes sum f_k d_k over all
/// contacts, which is volume times stress, by
///
///   K e dt + C (e - e_last) at most,        K = sum k d_k^2, C likewise with the dashpots
///
/// where d is the branch and k the stiffness of a contact. (Along one axis alone normal stiffness
/// gives sum k d_k^4 / d^2 and shear stiffness, if not larger, the rest at most; along all three at
/// once sum k d_k^2.) The servo takes the rate that closes a share `gain` of the gap. Where nothing
/// touches, the cell moves at the limit.
struct CellControl {
  std::string name;  ///< as the scene says it
  CellAxis axis{CellAxis::x};
  WallTarget target{WallTarget::stress};  ///< of shear, a strain rate only
  double value{0};                        ///< [Pa], [1/s]
  double gain{0.3};                       ///< of the servo, in (0, 1)
  double rate_limit{0};                   ///< of the servo [1/s]
};

/// What grains do to the cell at one step, summed over all contacts.
struct CellReaction {
  UpperMat3 virial;  ///< force (x) branch, volume times stress, compression positive [N m]
  Vec3 stiffness;    ///< K by axis [N m]
  Vec3 damping;      ///< C by axis [N m s]

  CellReaction& operator+=(const CellReaction& b) {
    virial += b.virial;
    stiffness += b.stiffness;
    damping += b.damping;
    return *this;
  }
};

/// Normal stress by axis, or shear stress, compression positive [Pa].
[[nodiscard]] double stress_of(CellAxis axis, const CellReaction& reaction,
                               const PeriodicCell& cell);

/// The rates of the edges over the next step [m/s].
[[nodiscard]] UpperMat3 rates_for(std::span<const CellControl> controls,
                                  const CellReaction& reaction, const PeriodicCell& cell,
                                  double time_step);

}  // namespace reckon
