// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/images_in_cell.hpp"

#include <cmath>

#include "reckon/math/inverse.hpp"

namespace reckon {
namespace {

std::vector<Vec3> own_ways(const GrainsOfCell& grains) {
  std::vector<Vec3> ways = grains.positions;
  for (std::size_t n = 0; n < ways.size(); ++n) ways[n] += grains.shifts[n];
  return ways;
}

Vec3 mean_of(const std::vector<Vec3>& points) {
  Vec3 sum;
  for (const Vec3& point : points) sum += point;
  return 1 / static_cast<double>(points.size()) * sum;
}

/// The gradient F for which F (x - mean) comes nearest to what became of x - mean.
Mat3 deformation(const std::vector<Vec3>& before, const std::vector<Vec3>& after) {
  const Vec3 start = mean_of(before);
  const Vec3 end = mean_of(after);
  Mat3 mixed{{}, {}, {}};
  Mat3 squares{{}, {}, {}};
  for (std::size_t n = 0; n < before.size(); ++n) {
    mixed += outer(after[n] - end, before[n] - start);
    squares += outer(before[n] - start, before[n] - start);
  }
  return mixed * inverse(squares);
}

Vec3 rounded(const Vec3& v) { return {std::round(v.x), std::round(v.y), std::round(v.z)}; }

}  // namespace

std::vector<Vec3> images_later(const GrainsOfCell& start, const GrainsOfCell& end) {
  std::vector<Vec3> ways = own_ways(end);
  const Mat3 carried = inverse(end.edges) * deformation(own_ways(start), ways) * start.edges;
  const Mat3 multiples{rounded(carried.row_x), rounded(carried.row_y), rounded(carried.row_z)};
  const Mat3 lattice = end.edges * multiples * inverse(start.edges);
  for (std::size_t n = 0; n < ways.size(); ++n) ways[n] -= lattice * start.shifts[n];
  return ways;
}

}  // namespace reckon
