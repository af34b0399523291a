// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/local_strain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "reckon/analysis/delaunay.hpp"
#include "reckon/math/inverse.hpp"
#include "reckon/math/portable.hpp"
#include "reckon/math/symmetric_eigen.hpp"

namespace reckon {
namespace {

/// Three edges that leave the first corner, as columns.
Mat3 edges(const Tetrahedron& cell, std::span<const Vec3> points) {
  const Vec3& first = points[cell[0]];
  return transpose({points[cell[1]] - first, points[cell[2]] - first, points[cell[3]] - first});
}

double longest_edge_of(const Tetrahedron& cell, std::span<const Vec3> points) {
  double longest = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      longest = std::max(longest, norm(points[cell[a]] - points[cell[b]]));
    }
  }
  return longest;
}

}  // namespace

std::vector<LocalStrain> local_strain(std::span<const Vec3> before, std::span<const Vec3> after,
                                      double longest_edge) {
  constexpr double sliver = 1e-3;
  constexpr double flat = 1e-12;  // squared stretch of a collapsed tetrahedron
  std::vector<LocalStrain> strains(before.size());
  for (const Tetrahedron& cell : delaunay(before)) {
    const Mat3 start = edges(cell, before);
    const double volume = std::abs(determinant(start)) / 6;
    const double longest = longest_edge_of(cell, before);
    if (!(longest <= longest_edge) || !(volume > sliver * longest * longest * longest)) continue;
    const Mat3 gradient = edges(cell, after) * inverse(start);
    const Vec3 squared = symmetric_eigen(transpose(gradient) * gradient).values;
    Vec3 strain;
    for (int axis = 0; axis < 3; ++axis) {
      strain[axis] = -0.5 * portable::log(std::max(squared[axis], flat));
    }
    const double volumetric = strain.x + strain.y + strain.z;
    const Vec3 deviator = strain - volumetric / 3 * Vec3{1, 1, 1};
    const double shear = std::sqrt(2.0 / 3 * squared_norm(deviator));
    for (const std::uint32_t grain : cell) {
      strains[grain].shear += volume * shear;
      strains[grain].volumetric += volume * volumetric;
      strains[grain].volume += volume;
    }
  }
  for (LocalStrain& strain : strains) {
    if (!strain.is_known()) continue;
    strain.shear /= strain.volume;
    strain.volumetric /= strain.volume;
  }
  return strains;
}

}  // namespace reckon
