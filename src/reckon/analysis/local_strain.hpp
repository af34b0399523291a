// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// How the surroundings of one grain deformed between two moments.
struct LocalStrain {
  double shear{0};       ///< sqrt(2/3 e:e), e the deviator of the logarithmic strain
  double volumetric{0};  ///< -ln of the volume's ratio: compression positive
  double volume{0};      ///< at the start, of the tetrahedra that it is averaged over [m^3]

  [[nodiscard]] bool is_known() const { return volume > 0; }
};

/// By grain: the strain of the tetrahedra of a Delaunay triangulation of the centres at the start
/// that it is a corner of, averaged by volume, as O'Sullivan et al. (2003) and Bagi (2006) do. Each
/// tetrahedron deforms by the gradient F that takes its edges at the start to those at the end;
/// its strain is ln(F^T F) / 2, which turning as a whole does not change. Tetrahedra with an edge
/// longer than `longest_edge` [m] bridge the outside and do not count; nor do slivers, flatter
/// than a thousandth of the volume of their longest edge's cube. `before` and `after` are the
/// same grains' centres [m].
[[nodiscard]] std::vector<LocalStrain> local_strain(std::span<const Vec3> before,
                                                    std::span<const Vec3> after,
                                                    double longest_edge);

}  // namespace reckon
