// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/neighbor/linked_bins.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace reckon {
namespace {

constexpr int most_layers = 24;

/// Bins are wider than the reach by this much, so that no rounding puts partners two bins apart.
constexpr double widening = 1 + 1e-9;

}  // namespace

LinkedBins::LinkedBins(std::span<const Vec3> positions, std::span<const double> radii, double skin)
    : positions_{positions}, layer_is_used_(most_layers, false) {
  const std::size_t count = positions.size();
  const auto table_size = std::bit_ceil(2 * count + 2);
  shift_ = 64 - static_cast<int>(std::countr_zero(table_size));
  bin_.resize(count);
  next_.assign(count, end_of_chain);
  first_.assign(table_size, end_of_chain);
  if (count == 0) return;
  widest_ = (2 * *std::max_element(radii.begin(), radii.end()) + skin) * widening;
  for (auto grain = static_cast<std::uint32_t>(count); grain-- > 0;) {
    const double need = (2 * radii[grain] + skin) * widening;
    int layer = 0;
    while (layer + 1 < most_layers && std::ldexp(widest_, -(layer + 1)) >= need) ++layer;
    layer_is_used_[static_cast<std::size_t>(layer)] = true;
    bin_[grain] = bin_in_layer(grain, layer);
    std::uint32_t& first = first_[slot_of(bin_[grain])];
    next_[grain] = first;
    first = grain;
  }
}

LinkedBins::Bin LinkedBins::bin_in_layer(std::uint32_t grain, int layer) const {
  const double width = std::ldexp(widest_, -layer);
  const auto coordinate = [width](double x) {
    return static_cast<std::int64_t>(std::floor(std::fmin(std::fmax(x / width, -0x1p60), 0x1p60)));
  };
  const Vec3& p = positions_[grain];
  return {coordinate(p.x), coordinate(p.y), coordinate(p.z), layer};
}

}  // namespace reckon
