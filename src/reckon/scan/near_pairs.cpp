// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/near_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

struct Posed {
  const ShapeView& shape;
  Mat3 rotation;
  Vec3 position;

  [[nodiscard]] Vec3 to_world(const Vec3& body) const { return rotation * body + position; }
  [[nodiscard]] Vec3 to_body(const Vec3& world) const {
    return transposed_times(rotation, world - position);
  }
};

/// Looks for the node of `nodes` that lies deepest in `field`; `sign` turns the normal from a to b.
void search(const Posed& nodes, const Posed& field, double sign, NearPair& best) {
  for (const NodeCluster& cluster : nodes.shape.clusters) {
    const Vec3 center = nodes.to_world(cluster.center_body);
    const double far = field.shape.bounding_radius + cluster.radius + std::max(best.gap, 0.0);
    if (squared_norm(center - field.position) > far * far) continue;
    for (std::uint32_t n = cluster.first; n < cluster.first + cluster.count; ++n) {
      const Vec3 world = nodes.to_world(nodes.shape.nodes.position(n));
      const auto sample = field.shape.level_set.sample(field.to_body(world));
      if (!sample.inside_grid || !(sample.phi < best.gap)) continue;
      best.gap = sample.phi;
      best.point_world = world;
      best.normal_world = sign * normalized(field.rotation * sample.gradient_body);
    }
  }
}

/// Trilinear interpolation between voxel centres; voxels outside count as the nearest inside.
double value_at(const GrayVolume& gray, const Vec3& world) {
  std::array<std::int32_t, 3> cell{};
  std::array<double, 3> place{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double g =
        std::clamp(world[axis] / gray.voxel - 0.5, 0.0, static_cast<double>(gray.dims[a] - 1));
    cell[a] = std::min(static_cast<std::int32_t>(g), std::max(gray.dims[a] - 2, 0));
    place[a] = g - cell[a];
  }
  double value = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> step{corner & 1, corner >> 1 & 1, corner >> 2};
    double weight = 1;
    std::array<std::int32_t, 3> at = cell;
    for (std::size_t a = 0; a < 3; ++a) {
      weight *= step[a] == 1 ? place[a] : 1 - place[a];
      at[a] = std::min(cell[a] + step[a], gray.dims[a] - 1);
    }
    value += weight * gray.values[gray.index(at[0], at[1], at[2])];
  }
  return value;
}

/// The void share summed up along a line through `center` [voxels].
double void_along_line(const GrayVolume& gray, const GrayLevels& levels, const Vec3& center,
                       const Vec3& direction) {
  constexpr int half_steps = 14;
  constexpr double step = 0.25;  // [voxels]
  double sum = 0;
  for (int n = -half_steps; n <= half_steps; ++n) {
    const double t = step * n;
    sum += step * (1 - levels.share(value_at(gray, center + t * gray.voxel * direction)));
  }
  return sum;
}

template <class Visit>
void for_each_in_disk(int radius, Visit&& visit) {
  for (int u = -radius; u <= radius; ++u) {
    for (int v = -radius; v <= radius; ++v) {
      if (u * u + v * v <= radius * radius) visit(u, v);
    }
  }
}

}  // namespace

std::vector<NearPair> near_pairs(std::span<const ShapeView> shapes,
                                 std::span<const GrainState> grains, double reach) {
  const auto low_x = [&](std::uint32_t n) {
    return grains[n].position.x - shapes[grains[n].shape.get()].bounding_radius;
  };
  std::vector<std::uint32_t> order(grains.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t n, std::uint32_t m) { return low_x(n) < low_x(m); });
  std::vector<std::vector<NearPair>> found(grains.size());
  parallel_for(order.size(), 16, [&](std::size_t o) {
    const auto posed = [&](std::uint32_t n) {
      return Posed{shapes[grains[n].shape.get()], rotation_matrix(grains[n].orientation),
                   grains[n].position};
    };
    const Posed first = posed(order[o]);
    const double end = first.position.x + first.shape.bounding_radius + reach;
    for (std::size_t p = o + 1; p < order.size() && low_x(order[p]) <= end; ++p) {
      const Posed second = posed(order[p]);
      const double far = first.shape.bounding_radius + second.shape.bounding_radius + reach;
      if (squared_norm(first.position - second.position) > far * far) continue;
      const bool in_order = order[o] < order[p];
      const Posed& a = in_order ? first : second;
      const Posed& b = in_order ? second : first;
      NearPair pair{std::min(order[o], order[p]),
                    std::max(order[o], order[p]),
                    std::nextafter(reach, std::numeric_limits<double>::infinity()),
                    {},
                    {}};
      const double nothing = pair.gap;
      search(a, b, -1, pair);
      search(b, a, 1, pair);
      if (pair.gap < nothing) found[o].push_back(pair);
    }
  });
  std::vector<NearPair> pairs;
  for (const auto& some : found) pairs.insert(pairs.end(), some.begin(), some.end());
  std::sort(pairs.begin(), pairs.end(), [](const NearPair& p, const NearPair& q) {
    return p.a != q.a ? p.a < q.a : p.b < q.b;
  });
  return pairs;
}

double gray_gap(const GrayVolume& gray, const GrayLevels& levels, const NearPair& pair) {
  constexpr int search_reach = 10;  // in half voxels
  constexpr int mean_reach = 2;
  const Vec3 helper = std::abs(pair.normal_world.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 along_u = normalized(cross(helper, pair.normal_world));
  const Vec3 along_v = cross(pair.normal_world, along_u);
  const auto void_along = [&](int u, int v) {
    const Vec3 center = pair.point_world + 0.5 * gray.voxel * (u * along_u + v * along_v);
    return void_along_line(gray, levels, center, pair.normal_world);
  };
  int best_u = 0;
  int best_v = 0;
  double least = std::numeric_limits<double>::infinity();
  for_each_in_disk(search_reach, [&](int u, int v) {
    const double sum = void_along(u, v);
    if (!(sum < least)) return;
    least = sum;
    best_u = u;
    best_v = v;
  });
  double mean = 0;
  int lines = 0;
  for_each_in_disk(mean_reach, [&](int u, int v) {
    mean += void_along(best_u + u, best_v + v);
    ++lines;
  });
  return mean / lines * gray.voxel;
}

}  // namespace reckon
