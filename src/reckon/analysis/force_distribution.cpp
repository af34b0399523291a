// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/force_distribution.hpp"

#include <cmath>

#include "reckon/core/exact_sum.hpp"

namespace reckon {

ForceDistribution force_distribution(std::span<const double> sizes, double width) {
  ForceDistribution found;
  found.width = width;
  ExactSum sum;
  for (const double size : sizes) {
    if (!(size > 0)) continue;
    sum.add(size);
    ++found.count;
  }
  if (found.count == 0) return found;
  found.mean = sum.value() / static_cast<double>(found.count);
  for (const double size : sizes) {
    if (!(size > 0)) continue;
    const auto bin = static_cast<std::size_t>(std::floor(size / found.mean / width));
    if (bin >= found.bins.size()) found.bins.resize(bin + 1, 0);
    ++found.bins[bin];
  }
  return found;
}

}  // namespace reckon
