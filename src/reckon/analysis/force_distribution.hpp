// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace reckon {

/// How the sizes of forces are spread around their mean: a histogram with bins of equal width.
struct ForceDistribution {
  double mean{0};   ///< of the forces that are not zero [N]
  double width{0};  ///< of a bin, over the mean
  std::uint64_t count{0};
  std::vector<std::uint64_t> bins;  ///< bin n holds forces from n width up to (n + 1) width

  /// Probability density P(f) of f = force over mean in the middle of a bin; sums to 1 over f.
  [[nodiscard]] double density(std::size_t bin) const {
    return count > 0 ? static_cast<double>(bins[bin]) / (static_cast<double>(count) * width) : 0;
  }
  [[nodiscard]] double middle(std::size_t bin) const {
    return (static_cast<double>(bin) + 0.5) * width;
  }
};

/// Of sizes [N], in bins of `width` times their mean, as many as the largest needs.
[[nodiscard]] ForceDistribution force_distribution(std::span<const double> sizes, double width);

}  // namespace reckon
