// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/boundary/membrane_side.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reckon {

MembraneSide::MembraneSide(const Membrane& membrane)
    : foot_{membrane.state().start.foot},
      axis_unit_{membrane.state().start.axis_unit},
      radius_{membrane.state().start.radius},
      columns_{membrane.mesh().columns()},
      rows_{membrane.mesh().rings()} {
  const Vec3 any = std::abs(axis_unit_.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  axis_u_ = normalized(cross(axis_unit_, any));
  axis_v_ = cross(axis_unit_, axis_u_);
  nodes_.reserve(membrane.nodes().size());
  for (const MembraneNode& node : membrane.nodes()) nodes_.push_back(place_of(node.position));
  const auto [lowest, highest] =
      std::minmax_element(nodes_.begin(), nodes_.end(),
                          [](const Place& a, const Place& b) { return a.height < b.height; });
  low_ = lowest->height;
  high_ = highest->height;
  bins_.resize(columns_ * rows_);
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) {
    const auto around = membrane.mesh().neighbors(node);
    // The triangles beside the bond to the next node of the ring: each is met at one node.
    for (const auto& [a, b] : {std::pair{around[0], around[1]}, std::pair{around[1], around[2]}}) {
      if (a != MembraneMesh::none && b != MembraneMesh::none) add({node, a, b});
    }
  }
}

MembraneSide::Place MembraneSide::place_of(const Vec3& point) const {
  const Vec3 from_foot = point - foot_;
  return {dot(from_foot, axis_u_), dot(from_foot, axis_v_), dot(from_foot, axis_unit_)};
}

std::size_t MembraneSide::row_of(double height) const {
  const double share = (height - low_) / (high_ - low_) * static_cast<double>(rows_);
  return static_cast<std::size_t>(std::clamp(share, 0.0, static_cast<double>(rows_ - 1)));
}

double MembraneSide::turns_of(const Place& place) const {
  return std::atan2(place.v, place.u) / (2 * std::numbers::pi) + 0.5;
}

std::size_t MembraneSide::column_of(double turns) const {
  const double share = turns * static_cast<double>(columns_);
  return static_cast<std::size_t>(std::clamp(share, 0.0, static_cast<double>(columns_ - 1)));
}

void MembraneSide::add(const Triangle& triangle) {
  double low_turns = 1;
  double high_turns = 0;
  double low = high_;
  double high = low_;
  for (const std::uint32_t corner : triangle) {
    const double turns = turns_of(nodes_[corner]);
    low_turns = std::min(low_turns, turns);
    high_turns = std::max(high_turns, turns);
    low = std::min(low, nodes_[corner].height);
    high = std::max(high, nodes_[corner].height);
  }
  // One that spans half a turn lies across the seam of the angle, or around the axis.
  const bool everywhere = high_turns - low_turns >= 0.5;
  const std::size_t first = everywhere ? 0 : column_of(low_turns);
  const std::size_t last = everywhere ? columns_ - 1 : column_of(high_turns);
  for (std::size_t row = row_of(low); row <= row_of(high); ++row) {
    for (std::size_t column = first; column <= last; ++column) {
      bins_[row * columns_ + column].push_back(triangle);
    }
  }
}

/// In a frame whose first axis is the line's own, a triangle is crossed where its shadow along the
/// line holds the line and the line has not passed it.
bool MembraneSide::crosses(const Place& from, const Triangle& triangle) const {
  const double length = std::sqrt(from.u * from.u + from.v * from.v);
  const double cos = length > 0 ? from.u / length : 1;
  const double sin = length > 0 ? from.v / length : 0;
  std::array<std::array<double, 3>, 3> corner{};  // along the line, across it, up
  for (std::size_t c = 0; c < 3; ++c) {
    const Place& node = nodes_[triangle[c]];
    corner[c] = {node.u * cos + node.v * sin - length, node.v * cos - node.u * sin,
                 node.height - from.height};
  }
  const auto doubled_area = [&](std::size_t a, std::size_t b) {
    return corner[a][1] * corner[b][2] - corner[b][1] * corner[a][2];
  };
  const double w0 = doubled_area(1, 2);
  const double w1 = doubled_area(2, 0);
  const double w2 = doubled_area(0, 1);
  const bool holds = (w0 > 0 && w1 > 0 && w2 > 0) || (w0 < 0 && w1 < 0 && w2 < 0);
  if (!holds) return false;
  const double along = (w0 * corner[0][0] + w1 * corner[1][0] + w2 * corner[2][0]) / (w0 + w1 + w2);
  return along > 0;
}

bool MembraneSide::crosses_oddly(const Place& from) const {
  const auto& near = bins_[row_of(from.height) * columns_ + column_of(turns_of(from))];
  return std::count_if(near.begin(), near.end(),
                       [&](const Triangle& triangle) { return crosses(from, triangle); }) %
             2 ==
         1;
}

bool MembraneSide::is_outside(const Vec3& point) const {
  const Place place = place_of(point);
  if (!(place.height > low_ && place.height < high_)) return false;
  const double nudge = 1e-6 * radius_;
  for (const auto& [u, height] : {std::pair{0.0, 0.0}, std::pair{nudge, 0.7 * nudge},
                                  std::pair{-0.6 * nudge, -0.9 * nudge}}) {
    if (crosses_oddly({place.u + u, place.v + 0.5 * u, place.height + height})) return false;
  }
  return true;
}

}  // namespace reckon
