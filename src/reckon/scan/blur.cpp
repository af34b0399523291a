// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/blur.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "reckon/math/portable.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

/// Filters `width` lines that lie side by side: their numbers stand in rows, `stride` apart.
/// The vectors are scratch.
void blur_lines(float* values, std::size_t width, std::size_t length, std::size_t stride,
                const std::vector<float>& weights, std::vector<float>& padded,
                std::vector<float>& sum) {
  const std::size_t reach = weights.size() - 1;
  padded.resize(width * (length + 2 * reach));
  for (std::size_t n = 0; n < length + 2 * reach; ++n) {
    const std::size_t inside = std::clamp(n, reach, reach + length - 1) - reach;
    std::copy_n(values + inside * stride, width, padded.data() + n * width);
  }
  sum.resize(width * length);
  const float* const middle = padded.data() + reach * width;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = weights[0] * middle[i];
  for (std::size_t r = 1; r <= reach; ++r) {
    const float weight = weights[r];
    const float* const before = middle - r * width;
    const float* const after = middle + r * width;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * (before[i] + after[i]);
  }
  for (std::size_t n = 0; n < length; ++n) {
    std::copy_n(sum.data() + n * width, width, values + n * stride);
  }
}

/// Filters all lines along one axis.
void blur_axis(GrayVolume& volume, std::size_t axis, const std::vector<float>& weights) {
  const auto size = [&](std::size_t a) { return static_cast<std::size_t>(volume.dims[a]); };
  const std::size_t row = size(0);
  const std::size_t layer = row * size(1);
  float* const values = volume.values.data();
  parallel_for(size(axis == 2 ? 1 : 2), 1, [&](std::size_t n) {
    std::vector<float> padded;
    std::vector<float> sum;
    const auto blur = [&](float* first, std::size_t width, std::size_t length, std::size_t stride) {
      blur_lines(first, width, length, stride, weights, padded, sum);
    };
    if (axis == 2) {
      blur(values + n * row, row, size(2), layer);
    } else if (axis == 1) {
      blur(values + n * layer, row, size(1), row);
    } else {
      for (std::size_t j = 0; j < size(1); ++j) blur(values + n * layer + j * row, 1, row, 1);
    }
  });
}

}  // namespace

std::int32_t blur_reach(double deviation) {
  return static_cast<std::int32_t>(std::ceil(4 * deviation));
}

void blur_volume(GrayVolume& volume, double deviation) {
  if (!(deviation > 0)) return;
  const auto reach = static_cast<std::size_t>(blur_reach(deviation));
  std::vector<double> weights;
  double sum = 0;
  for (std::size_t r = 0; r <= reach; ++r) {
    const double distance = static_cast<double>(r) / deviation;
    weights.push_back(portable::exp(-0.5 * distance * distance));
    sum += (r == 0 ? 1 : 2) * weights.back();
  }
  std::vector<float> shares;
  shares.reserve(weights.size());
  for (const double weight : weights) shares.push_back(static_cast<float>(weight / sum));
  for (std::size_t axis = 0; axis < 3; ++axis) blur_axis(volume, axis, shares);
}

}  // namespace reckon
