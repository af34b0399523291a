// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/neighbor/linked_bins.hpp"

#include <bit>
#include <cmath>

namespace reckon {

LinkedBins::LinkedBins(std::span<const Vec3> positions, double reach) {
  const std::size_t count = positions.size();
  const auto table_size = std::bit_ceil(2 * count + 2);
  shift_ = 64 - static_cast<int>(std::countr_zero(table_size));
  bin_.resize(count);
  next_.assign(count, end_of_chain);
  first_.assign(table_size, end_of_chain);
  const auto coordinate = [reach](double x) {
    return static_cast<std::int64_t>(std::floor(std::fmin(std::fmax(x / reach, -0x1p60), 0x1p60)));
  };
  for (std::size_t grain = count; grain-- > 0;) {
    const Vec3& p = positions[grain];
    bin_[grain] = {coordinate(p.x), coordinate(p.y), coordinate(p.z)};
    std::uint32_t& first = first_[slot_of(bin_[grain])];
    next_[grain] = first;
    first = static_cast<std::uint32_t>(grain);
  }
}

}  // namespace reckon
