// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/domain/regions.hpp"

#include <algorithm>
#include <cmath>

namespace reckon {

namespace {

struct Interval {
  double low;
  double high;
};

/// Distance of two intervals of a line, or of a circle of length `period` if that is above zero.
double gap_between(Interval a, Interval b, double period) {
  const auto gap = [](const Interval& p, const Interval& q) {
    return std::max({p.low - q.high, q.low - p.high, 0.0});
  };
  if (!(period > 0)) return gap(a, b);
  const auto cut = [period](const Interval& p) {
    return Interval{std::max(p.low, 0.0), std::min(p.high, period)};
  };
  a = cut(a);
  b = cut(b);
  return std::min({gap(a, b), gap(a, {b.low - period, b.high - period}),
                   gap(a, {b.low + period, b.high + period})});
}

}  // namespace

double Region::squared_distance(const Vec3& p, const Vec3& period) const {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double outside = gap_between({low[axis], high[axis]}, {p[axis], p[axis]}, period[axis]);
    sum += outside * outside;
  }
  return sum;
}

bool Region::within(const Region& other, double reach, const Vec3& period) const {
  if (empty() || other.empty()) return false;
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double gap =
        gap_between({low[axis], high[axis]}, {other.low[axis], other.high[axis]}, period[axis]);
    sum += gap * gap;
  }
  return sum <= reach * reach;
}

Region bounding_region(std::span<const Vec3> points) {
  constexpr double inf = Region::infinity;
  Region region{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (const Vec3& p : points) {
    for (int axis = 0; axis < 3; ++axis) {
      region.low[axis] = std::min(region.low[axis], p[axis]);
      region.high[axis] = std::max(region.high[axis], std::nextafter(p[axis], inf));
    }
  }
  return region;
}

int region_holding(std::span<const Region> regions, const Vec3& p, int guess) {
  if (regions[static_cast<std::size_t>(guess)].contains(p)) return guess;
  const auto found = std::find_if(regions.begin(), regions.end(),
                                  [&](const Region& region) { return region.contains(p); });
  return found != regions.end() ? static_cast<int>(found - regions.begin()) : guess;
}

int GridCut::bin_of(int axis, double coordinate) const {
  const double bin = std::floor((coordinate - origin[axis]) / bin_size[axis]);
  const auto last = static_cast<double>(bins[static_cast<std::size_t>(axis)] - 1);
  return static_cast<int>(std::clamp(bin, 0.0, last));
}

int GridCut::block_of(int axis, int bin) const {
  const auto a = static_cast<std::size_t>(axis);
  int block = static_cast<int>(static_cast<long>(bin) * blocks[a] / bins[a]);
  while (first_bin(axis, block + 1) <= bin) ++block;
  while (first_bin(axis, block) > bin) --block;
  return block;
}

std::array<int, 3> GridCut::block_place(int block) const {
  return {block % blocks[0], block / blocks[0] % blocks[1], block / (blocks[0] * blocks[1])};
}

int GridCut::owner_of(const Vec3& p) const {
  std::array<int, 3> place{};
  for (int axis = 0; axis < 3; ++axis) {
    place[static_cast<std::size_t>(axis)] = block_of(axis, bin_of(axis, p[axis]));
  }
  return block_at(place);
}

namespace {

/// Of all ways to write `ranks` as a product of three, the one whose blocks have the least surface
/// and hold at least one bin along each axis; no product: {0, 0, 0}.
std::array<int, 3> best_blocks(int ranks, const std::array<int, 3>& bins, const Vec3& size) {
  std::array<int, 3> best{0, 0, 0};
  double least = Region::infinity;
  for (int x = 1; x <= std::min(ranks, bins[0]); ++x) {
    if (ranks % x != 0) continue;
    for (int y = 1; y <= std::min(ranks / x, bins[1]); ++y) {
      if (ranks / x % y != 0) continue;
      const int z = ranks / x / y;
      if (z > bins[2]) continue;
      const Vec3 block{size.x / x, size.y / y, size.z / z};
      const double surface = block.x * block.y + block.y * block.z + block.z * block.x;
      if (surface < least) {
        least = surface;
        best = {x, y, z};
      }
    }
  }
  return best;
}

}  // namespace

GridCut cut_grid(const Region& domain, int ranks, double reach) {
  GridCut cut;
  cut.origin = domain.empty() ? Vec3{} : domain.low;
  const Vec3 size = domain.empty() ? Vec3{reach, reach, reach} : domain.high - domain.low;
  constexpr double most_bins = 1 << 20;  // along an axis, so that three of them count in 64 bits
  for (int axis = 0; axis < 3; ++axis) {
    const double bins = std::clamp(std::floor(size[axis] / reach), 1.0, most_bins);
    cut.bins[static_cast<std::size_t>(axis)] = static_cast<int>(bins);
    cut.bin_size[axis] = std::max(size[axis] / bins, reach);
  }
  for (int blocks = ranks; blocks >= 1; --blocks) {
    cut.blocks = best_blocks(blocks, cut.bins, size);
    if (cut.blocks[0] > 0) break;
  }
  return cut;
}

}  // namespace reckon
