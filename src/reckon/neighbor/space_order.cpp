// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/neighbor/space_order.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace reckon {
namespace {

constexpr int bits_per_axis = 21;

/// Moves bit n to bit 3n.
std::uint64_t spread(std::uint64_t bits) {
  bits &= 0x1FFFFF;
  bits = (bits | bits << 32) & 0x001F00000000FFFF;
  bits = (bits | bits << 16) & 0x001F0000FF0000FF;
  bits = (bits | bits << 8) & 0x100F00F00F00F00F;
  bits = (bits | bits << 4) & 0x10C30C30C30C30C3;
  bits = (bits | bits << 2) & 0x1249249249249249;
  return bits;
}

}  // namespace

std::vector<std::uint32_t> space_order(std::span<const Vec3> positions) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low{infinity, infinity, infinity};
  Vec3 high = -low;
  for (const Vec3& p : positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3 size = high - low;
  const double side = std::max({size.x, size.y, size.z});
  const double steps = side > 0 ? ((1 << bits_per_axis) - 1) / side : 0;
  std::vector<std::uint64_t> keys;
  keys.reserve(positions.size());
  for (const Vec3& p : positions) {
    const Vec3 place = steps * (p - low);
    keys.push_back(spread(static_cast<std::uint64_t>(place.x)) |
                   spread(static_cast<std::uint64_t>(place.y)) << 1 |
                   spread(static_cast<std::uint64_t>(place.z)) << 2);
  }
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t s, std::uint32_t t) { return keys[s] < keys[t]; });
  return order;
}

}  // namespace reckon
