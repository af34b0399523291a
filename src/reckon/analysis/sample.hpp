// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "reckon/analysis/stress.hpp"
#include "reckon/simulation/simulation.hpp"

namespace reckon {

/// The quantities of a sample between walls that a laboratory measures. Stresses and strains count
/// compression positive; tensors have the force's or first vector's component as row. All sums over
/// contacts are exact before their one rounding, so nothing depends on threads or ranks.
struct SampleMeasurement {
  // Of the space that the walls close off; zeros where they do not.
  bool enclosed{false};
  double volume{0};                   ///< exact, see Enclosure [m^3]
  Vec3 size;                          ///< of its bounding box [m]
  double void_ratio{0};               ///< (volume - solids) / solids
  Vec3 strain;                        ///< -ln(size / size at the start of the stage), by axis
  double volumetric_strain{0};        ///< -ln(volume / volume at the start of the stage)
  Vec3 total_strain;                  ///< -ln(size / size at step 0), by axis
  double total_volumetric_strain{0};  ///< -ln(volume / volume at step 0)
  /// The strain since step 0 along the axis that the test drives (StageSetup::axis); of a cell that
  /// is sheared, its shear strain.
  double axial_strain{0};

  /// Love-Weber: sum over all contacts of force (x) branch, over the volume. Branches go from
  /// centre to centre, and at walls from a grain's centre to the touching nodes [Pa].
  Mat3 stress{Vec3{}, Vec3{}, Vec3{}};
  /// From the walls alone: the sum of the walls' forces (x) where they act, over the volume. Equal
  /// to Love-Weber's but for what grains are out of balance, and what body forces do [Pa].
  Mat3 wall_stress{Vec3{}, Vec3{}, Vec3{}};
  StressInvariants invariants;  ///< of `stress`
  /// Signed q along the same axis: the stress along it less the mean of the other two, so that a
  /// cycle through the isotropic state is not folded; of a cell that is sheared, sqrt(3) times the
  /// shear stress [Pa].
  double axial_deviator{0};
  /// I = largest rate of strain * d * sqrt(density / p), with d the volume-weighted mean diameter
  /// of equal spheres. Below 1e-3 a test counts as quasi-static (da Cruz et al. 2005).
  double inertial_number{0};

  // Of the contact network.
  double coordination{0};  ///< contacts per grain, walls included
  /// The same over grains with at least two contacts (Thornton 2000).
  double mechanical_coordination{0};
  std::uint64_t rattlers{0};  ///< grains with fewer than two contacts
  /// Mean of n (x) n over contacts between grains; n is the mean normal of their touching nodes,
  /// as of the last step. Trace 1; a third of the identity when no direction is preferred.
  Mat3 contact_tensor{Vec3{}, Vec3{}, Vec3{}};
  Mat3 branch_tensor{Vec3{}, Vec3{}, Vec3{}};  ///< the same with directions from centre to centre
  double mean_force{0};                        ///< of the contacts between grains [N]
  double force_variation{0};                   ///< their standard deviation over their mean
  double largest_force{0};                     ///< over their mean

  friend bool operator==(const SampleMeasurement&, const SampleMeasurement&) = default;
};

/// Measures a sample. To be called after Simulation::measure() or contacts() at the same step,
/// whose forces it uses. Collective; the same on all ranks.
[[nodiscard]] SampleMeasurement measure_sample(const Simulation& simulation);

}  // namespace reckon
