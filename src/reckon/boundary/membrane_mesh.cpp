// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/membrane_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reckon/math/portable.hpp"

namespace reckon {

MembraneMesh::MembraneMesh(const CylinderPlace& place, double spacing) {
  const double around = 2 * std::numbers::pi * place.radius;
  columns_ = std::max(6U, static_cast<std::uint32_t>(std::lround(around / spacing)));
  const double columns = columns_;
  ring_bond_ = 2 * place.radius * portable::cos_sin_of_turns(0.5 / columns).sin;
  const double wanted_step = 0.5 * std::numbers::sqrt3 * ring_bond_;
  const auto steps =
      std::max(2U, static_cast<std::uint32_t>(std::lround(place.height / wanted_step)));
  rings_ = steps + 1;
  const double step = place.height / steps;

  const Vec3& axis = place.axis_unit;
  const Vec3 any = std::abs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(axis, any));
  const Vec3 v = cross(axis, u);
  places_.reserve(std::size_t{rings_} * columns_);
  for (std::uint32_t ring = 0; ring < rings_; ++ring) {
    for (std::uint32_t column = 0; column < columns_; ++column) {
      const double turns = (column + (ring % 2 == 1 ? 0.5 : 0.0)) / columns;
      const auto direction = portable::cos_sin_of_turns(turns);
      places_.push_back(place.foot + (ring * step) * axis +
                        place.radius * (direction.cos * u + direction.sin * v));
    }
  }
  cross_bond_ = norm(places_[columns_] - places_[0]);
  const Vec3 triangle = cross(places_[1] - places_[0], places_[columns_] - places_[0]);
  area_ = norm(triangle);  // six triangles, a third of each
}

double MembraneMesh::expected_size(const CylinderPlace& place, double spacing) {
  return 2 * std::numbers::pi * place.radius * place.height /
         (0.5 * std::numbers::sqrt3 * spacing * spacing);
}

std::array<std::uint32_t, 6> MembraneMesh::neighbors(std::uint32_t node) const {
  const std::uint32_t ring = node / columns_;
  const std::uint32_t column = node % columns_;
  const std::uint32_t next = column + 1 == columns_ ? 0 : column + 1;
  const std::uint32_t previous = column == 0 ? columns_ - 1 : column - 1;
  const bool turned = ring % 2 == 1;
  // In the rings above and below, the two nearest columns.
  const std::uint32_t right = turned ? next : column;
  const std::uint32_t left = turned ? column : previous;
  const std::uint32_t first = ring * columns_;
  std::array<std::uint32_t, 6> all{first + next, none, none, first + previous, none, none};
  if (ring + 1 < rings_) {
    all[1] = first + columns_ + right;
    all[2] = first + columns_ + left;
  }
  if (ring > 0) {
    all[4] = first - columns_ + left;
    all[5] = first - columns_ + right;
  }
  return all;
}

}  // namespace reckon
