// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "assemblies.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reckon/core/random.hpp"
#include "reckon/math/portable.hpp"

namespace reckon::bench {
namespace {

constexpr std::uint64_t seed = 31;
constexpr double jitter = 0.25;         // of a place's size, each way along each axis
constexpr double solid_fraction = 0.6;  // of dense sand
constexpr double bounding = 1.25;       // bounding sphere / sphere of equal volume
constexpr double size_spread = 1.5;     // largest / median size
constexpr double skin_share = 0.05;     // skin / median radius

/// Median bounding radius of grains that fill places of this size to the solid fraction.
double bounding_radius(double place) {
  return bounding * place * std::cbrt(solid_fraction * 0.75 / std::numbers::pi);
}

/// Sizes between 1 / spread and spread, even in their logarithm.
double drawn_size(RandomStream& random, double spread) {
  return portable::exp(random.uniform(-1, 1) * portable::log(spread));
}

void add_grain(Assembly& assembly, const Vec3& middle, double place, double radius, double spread) {
  RandomStream random{seed, RandomPurpose::placement, assembly.positions.size()};
  Vec3 p = middle;
  for (int axis = 0; axis < 3; ++axis) p[axis] += random.uniform(-jitter, jitter) * place;
  assembly.positions.push_back(p);
  assembly.radii.push_back(radius * drawn_size(random, spread));
}

/// Fills a cube with grains on a lattice, of which evenly spread places stay free.
void fill_cube(Assembly& assembly, std::uint32_t grains, double edge, double spread) {
  auto per_edge = static_cast<std::uint64_t>(std::cbrt(static_cast<double>(grains)));
  while (per_edge * per_edge * per_edge < grains) ++per_edge;
  const std::uint64_t places = per_edge * per_edge * per_edge;
  const double place = edge / static_cast<double>(per_edge);
  const double radius = bounding_radius(edge / std::cbrt(static_cast<double>(grains)));
  for (std::uint64_t n = 0; n < places; ++n) {
    if ((n + 1) * grains / places == n * grains / places) continue;
    const std::uint64_t row = n / per_edge;
    const std::uint64_t layer = row / per_edge;
    const Vec3 index{static_cast<double>(n % per_edge), static_cast<double>(row % per_edge),
                     static_cast<double>(layer)};
    add_grain(assembly, place * (index + Vec3{0.5, 0.5, 0.5}), place, radius, spread);
  }
}

/// As a run does: the smallest box, and bins that hold the largest grain.
void bound(Assembly& assembly) {
  assembly.domain = bounding_region(assembly.positions);
  assembly.reach =
      2 * *std::max_element(assembly.radii.begin(), assembly.radii.end()) + assembly.skin;
}

}  // namespace

Assembly packed_cube(std::uint32_t grains, double edge, double bin) {
  Assembly assembly;
  assembly.name = "cube";
  const double radius = bounding_radius(edge / std::cbrt(static_cast<double>(grains)));
  assembly.skin = skin_share * radius;
  assembly.domain = {{0, 0, 0}, {edge, edge, edge}};
  assembly.reach = bin;
  const double largest = 0.5 * (bin - assembly.skin) / radius;
  fill_cube(assembly, grains, edge, std::clamp(largest, 1.0, size_spread));
  return assembly;
}

Assembly dense_cube(std::uint32_t grains) {
  Assembly assembly;
  assembly.name = "cube";
  const double place = 1 / (2 * bounding_radius(1));  // so that the median bounding diameter is 1
  assembly.skin = skin_share * 0.5;
  fill_cube(assembly, grains, place * std::cbrt(static_cast<double>(grains)), size_spread);
  bound(assembly);
  return assembly;
}

Assembly cone_heap(std::uint32_t grains) {
  Assembly assembly;
  assembly.name = "heap";
  assembly.skin = skin_share * 0.5;
  const double place = 1 / (2 * bounding_radius(1));
  const double slope = 1 / std::numbers::sqrt3;  // tan 30 degrees
  // Grains of one place each fill the cone: volume = pi / 3 slope foot^3.
  const double foot =
      place * std::cbrt(3 * static_cast<double>(grains) / (std::numbers::pi * slope));
  const auto half = static_cast<int>(std::ceil(foot / place)) + 1;
  struct Place {
    double below_surface;
    Vec3 middle;
  };
  std::vector<Place> places;
  for (int k = 0; k < half; ++k) {
    for (int j = -half; j <= half; ++j) {
      for (int i = -half; i <= half; ++i) {
        const Vec3 middle = place * Vec3{double(i), double(j), double(k) + 0.5};
        const double outward = std::sqrt(middle.x * middle.x + middle.y * middle.y);
        places.push_back({(foot - outward) * slope - middle.z, middle});
      }
    }
  }
  // The deepest places, whose number makes the foot's estimate exact.
  std::stable_sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.below_surface > b.below_surface;
  });
  for (std::uint32_t n = 0; n < grains; ++n) {
    add_grain(assembly, places[n].middle, place, 0.5, size_spread);
  }
  bound(assembly);
  return assembly;
}

}  // namespace reckon::bench
