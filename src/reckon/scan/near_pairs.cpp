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

Posed pose(std::span<const ShapeView> shapes, const GrainState& grain) {
  return {shapes[grain.shape.get()], rotation_matrix(grain.orientation), grain.position};
}

/// Finds the node of `nodes` that lies deepest in `field`; `sign` turns the normal from a to b.
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
    const auto posed = [&](std::uint32_t n) { return pose(shapes, grains[n]); };
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

namespace {

/// A place amidst two surfaces.
struct Amidst {
  double larger_phi{std::numeric_limits<double>::infinity()};
  Vec3 place;
  Vec3 across;  // from the first surface to the second, not normalised
};

/// Newton steps across the gap to where both phi are the same: the larger one has a crease there,
/// which steps to all sides would hardly follow.
Amidst amidst(const Posed& a, const Posed& b, Vec3 place) {
  constexpr int rounds = 3;
  Amidst best;
  for (int round = 0; round < rounds; ++round) {
    const auto in_a = a.shape.level_set.sample(a.to_body(place));
    const auto in_b = b.shape.level_set.sample(b.to_body(place));
    if (!in_a.inside_grid || !in_b.inside_grid) break;
    const Vec3 across = a.rotation * in_a.gradient_body - b.rotation * in_b.gradient_body;
    const double larger = std::max(in_a.phi, in_b.phi);
    if (larger < best.larger_phi) best = {larger, place, across};
    const double slope = squared_norm(across);
    if (!(slope > 0.01)) break;
    place -= ((in_a.phi - in_b.phi) / slope) * across;
  }
  return best;
}

/// Minimises the larger phi by steps in 26 directions, halved where none improves.
void settle_between(const Posed& a, const Posed& b, NearPair& pair) {
  const double spacing = std::max(a.shape.level_set.spacing, b.shape.level_set.spacing);
  Amidst best = amidst(a, b, pair.point_world);
  if (!std::isfinite(best.larger_phi)) return;
  for (double step = 2 * spacing; step > 0.01 * spacing;) {
    const Vec3 center = best.place;
    bool improved = false;
    for (const double x : {-step, 0.0, step}) {
      for (const double y : {-step, 0.0, step}) {
        for (const double z : {-step, 0.0, step}) {
          const Amidst next = amidst(a, b, center + Vec3{x, y, z});
          if (!(next.larger_phi < best.larger_phi)) continue;
          best = next;
          improved = true;
        }
      }
    }
    if (!improved) step /= 2;
  }
  pair.gap = 2 * best.larger_phi;
  pair.point_world = best.place;
  if (squared_norm(best.across) > 0.01) pair.normal_world = normalized(best.across);
}

}  // namespace

std::vector<NearPair> near_surfaces(std::span<const ShapeView> shapes,
                                    std::span<const GrainState> grains, double reach) {
  // A node may be a little way from where the surfaces are nearest.
  double padding = 0;
  for (const ShapeView& shape : shapes) padding = std::max(padding, 2 * shape.level_set.spacing);
  std::vector<NearPair> pairs = near_pairs(shapes, grains, std::max(reach, padding));
  parallel_for(pairs.size(), 16, [&](std::size_t p) {
    settle_between(pose(shapes, grains[pairs[p].a]), pose(shapes, grains[pairs[p].b]), pairs[p]);
  });
  std::erase_if(pairs, [&](const NearPair& pair) { return !(pair.gap <= reach); });
  return pairs;
}

}  // namespace reckon
