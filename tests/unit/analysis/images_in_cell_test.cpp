// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/images_in_cell.hpp"

#include <gtest/gtest.h>

#include "reckon/core/random.hpp"
#include "reckon/grains/periodic_cell.hpp"

namespace reckon {
namespace {

GrainsOfCell put_into(const PeriodicCell& cell, const std::vector<Vec3>& ways) {
  const UpperMat3& h = cell.edges();
  GrainsOfCell grains{
      .positions = {},
      .shifts = {},
      .edges = {{h.diagonal.x, h.xy, h.xz}, {0, h.diagonal.y, h.yz}, {0, 0, h.diagonal.z}}};
  for (const Vec3& way : ways) {
    grains.positions.push_back(cell.wrapped(way));
    grains.shifts.push_back(way - grains.positions.back());
  }
  return grains;
}

/// Images that were in the cell follow its motion, wherever their grains went and although the
/// edges are others at the end: sheared by 1.3 times its height, the cell leans by 0.3 instead.
TEST(ImagesInCell, AreFollowedThroughBordersAndOtherEdges) {
  PeriodicCell cell{{1, 2, 3}, {true, true, true}, {{2, 2, 2.5}, 0, 0, 0}, {}};
  RandomStream random{7, RandomPurpose::other, 3};
  std::vector<Vec3> ways;
  for (int n = 0; n < 200; ++n) {
    ways.push_back({random.uniform(-4, 6), random.uniform(-4, 6), random.uniform(-4, 6)});
  }
  const GrainsOfCell start = put_into(cell, ways);
  std::vector<Vec3> images = start.positions;
  constexpr int steps = 100;
  constexpr double time_step = 1.0 / steps;
  for (int step = 0; step < steps; ++step) {
    const UpperMat3 rates{{-0.2, 0.1, 0}, 2.6, 0.4, 0};
    const UpperMat3 gradient = cell.advance(rates, time_step);
    for (std::vector<Vec3>* points : {&ways, &images}) {
      for (Vec3& x : *points) x += time_step * (gradient * (x - cell.center()));
    }
  }
  EXPECT_LT(std::abs(cell.edges().xy), 0.5 * cell.edges().diagonal.x) << "must have changed edges";
  for (std::size_t n = 0; n < ways.size(); ++n) {  // no grain moves quite as the cell does
    const Vec3 own{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
    ways[n] += own;
    images[n] += own;
  }
  const std::vector<Vec3> later = images_later(start, put_into(cell, ways));
  for (std::size_t n = 0; n < ways.size(); ++n) EXPECT_LT(norm(later[n] - images[n]), 1e-12) << n;
}

}  // namespace
}  // namespace reckon
