// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/grains/periodic_cell.hpp"

#include <algorithm>
#include <limits>

namespace reckon {

Vec3 PeriodicCell::widths() const {
  // Rows of H^-1 are the faces' normals over their distance.
  const Vec3 rows{norm({inverse_.diagonal.x, inverse_.xy, inverse_.xz}),
                  norm({0, inverse_.diagonal.y, inverse_.yz}), inverse_.diagonal.z};
  Vec3 widths;
  for (int axis = 0; axis < 3; ++axis) widths[axis] = is_periodic(axis) ? 1 / rows[axis] : 0;
  return widths;
}

double PeriodicCell::least_width() const {
  double least = std::numeric_limits<double>::infinity();
  const Vec3 all = widths();
  for (int axis = 0; axis < 3; ++axis) {
    if (is_periodic(axis)) least = std::min(least, all[axis]);
  }
  return least;
}

Vec3 PeriodicCell::place(const Vec3& point) const {
  const Vec3 s = fractions(point);
  const Vec3 all = widths();
  Vec3 place = point;
  for (int axis = 0; axis < 3; ++axis) {
    if (is_periodic(axis)) place[axis] = all[axis] * (s[axis] - std::floor(s[axis]));
  }
  return place;
}

double PeriodicCell::stretch() const {
  const bool is_right = edges_.xy == 0 && edges_.xz == 0 && edges_.yz == 0;
  return is_right ? 1 + 1e-9 : 1.75;  // more than the root of three
}

UpperMat3 PeriodicCell::advance(const UpperMat3& rates, double time_step) {
  rates_ = rates;
  const UpperMat3 over_step = gradient();
  edges_ += time_step * rates_;
  straighten();
  inverse_ = inverse(edges_);
  return over_step;
}

void PeriodicCell::straighten() {
  const auto edges_over = [](double lean, double edge) { return std::floor(lean / edge + 0.5); };
  const UpperMat3 old_edges = edges_;
  const UpperMat3 old_rates = rates_;
  // c less multiples of b, then b and c less multiples of a.
  const double b_of_c = periodic_[1] ? edges_over(old_edges.yz, old_edges.diagonal.y) : 0;
  edges_.yz -= b_of_c * old_edges.diagonal.y;
  edges_.xz -= b_of_c * old_edges.xy;
  rates_.yz -= b_of_c * old_rates.diagonal.y;
  rates_.xz -= b_of_c * old_rates.xy;
  if (!periodic_[0]) return;
  const double a_of_c = edges_over(edges_.xz, old_edges.diagonal.x);
  edges_.xz -= a_of_c * old_edges.diagonal.x;
  rates_.xz -= a_of_c * old_rates.diagonal.x;
  const double a_of_b = edges_over(old_edges.xy, old_edges.diagonal.x);
  edges_.xy -= a_of_b * old_edges.diagonal.x;
  rates_.xy -= a_of_b * old_rates.diagonal.x;
}

std::vector<Vec3> places_in(const PeriodicCell* cell, std::span<const Vec3> points) {
  std::vector<Vec3> places{points.begin(), points.end()};
  if (cell == nullptr) return places;
  for (Vec3& place : places) place = cell->place(place);
  return places;
}

}  // namespace reckon
