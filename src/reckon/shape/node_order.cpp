// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/shape/node_order.hpp"

#include <algorithm>
#include <numeric>

namespace reckon {
namespace {

int longest_axis(std::span<const Vec3> points, std::span<const std::uint32_t> order) {
  Vec3 low = points[order[0]];
  Vec3 high = low;
  for (const std::uint32_t n : order) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], points[n][axis]);
      high[axis] = std::max(high[axis], points[n][axis]);
    }
  }
  const Vec3 extent = high - low;
  const int best_of_xy = extent.y > extent.x ? 1 : 0;
  return extent.z > extent[best_of_xy] ? 2 : best_of_xy;
}

void split(std::span<const Vec3> points, std::span<std::uint32_t> order, std::size_t leaf) {
  const int axis = longest_axis(points, order);
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return points[a][axis] != points[b][axis] ? points[a][axis] < points[b][axis] : a < b;
  };
  if (order.size() <= leaf) {
    std::sort(order.begin(), order.end(), before);
    return;
  }
  // Whole leaves on the left, so that only the very last leaf of all is short.
  const std::size_t leaves = (order.size() + leaf - 1) / leaf;
  const std::size_t left = leaf * (leaves / 2);
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(left), order.end(),
                   before);
  split(points, order.first(left), leaf);
  split(points, order.subspan(left), leaf);
}

}  // namespace

std::vector<std::uint32_t> compact_order(std::span<const Vec3> points, std::uint32_t leaf) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  if (!order.empty()) split(points, order, leaf);
  return order;
}

SurfaceNodes in_compact_order(const SurfaceNodes& nodes) {
  std::vector<Vec3> points;
  for (std::size_t n = 0; n < nodes.size(); ++n) points.push_back(nodes.position(n));
  SurfaceNodes sorted;
  for (const std::uint32_t n : compact_order(points, nodes_per_cluster)) {
    sorted.x.push_back(nodes.x[n]);
    sorted.y.push_back(nodes.y[n]);
    sorted.z.push_back(nodes.z[n]);
    sorted.area.push_back(nodes.area[n]);
  }
  return sorted;
}

}  // namespace reckon
