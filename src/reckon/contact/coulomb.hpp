// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// A shear spring as the last step left it.
struct ShearSpring {
  Vec3 force;           ///< on the master [N]
  double stiffness{0};  ///< [N/m]; 0: not known, taken for that of this step

  [[nodiscard]] double stored() const {  ///< [J]
    return stiffness > 0 ? squared_norm(force) / (2 * stiffness) : 0;
  }
};

/// One step of the Coulomb spring (paper, B.2-B.5).
struct CoulombSlider {
  Vec3 force;      ///< on the master after the step [N]
  double lost{0};  ///< energy lost to sliding and to a change of stiffness [J]
};

/// Stretches `spring`, already in the tangent plane, by the tangential part of
/// `velocity` * `time_step`, then caps it at `limit` [N].
///
/// Where `stiffness` [N/m] is another than the spring had, the contact has grown or shrunk. What it
/// gains begins without force, so that a growing contact keeps its force; what it loses takes its
/// part of the force with it, so that a shrinking one keeps its stretch (Thornton et al. 2013). In
/// both cases the energy in store falls.
[[nodiscard]] inline CoulombSlider slide(const ShearSpring& spring, const Vec3& velocity,
                                         const Vec3& normal, double time_step, double stiffness,
                                         double limit) {
  const double before = spring.stiffness > 0 ? spring.stiffness : stiffness;
  // Each choice between values hangs on one comparison, so that loops over nodes become vectors.
  const double kept =
      (before > 0 ? std::min(stiffness, before) : 1.0) / (before > 0 ? before : 1.0);
  const Vec3 displacement = (velocity - dot(velocity, normal) * normal) * time_step;
  const Vec3 trial = kept * spring.force - stiffness * displacement;
  const double trial_squared = squared_norm(trial);
  const bool sticks = trial_squared <= limit * limit;
  Vec3 capped = (sticks ? 1.0 : limit / std::sqrt(trial_squared)) * trial;
  // Lost: what the step took in, the mean of the forces before and after times the displacement,
  // less what the spring now holds more than before.
  const double slip = sticks ? 0.0 : dot(spring.force + capped, trial - capped) / (2 * stiffness);
  const double grown = before > 0 ? std::max(1 / before - 1 / stiffness, 0.0) : 0.0;
  const double gone = stiffness > 0 ? (1 - kept) / stiffness : 0.0;
  return {capped,
          slip + 0.5 * (grown * squared_norm(spring.force) + gone * dot(spring.force, capped))};
}

}  // namespace reckon
