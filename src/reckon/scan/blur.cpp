// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/blur.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "reckon/math/portable.hpp"
#include "reckon/parallel/threads.hpp"

namespace reckon {
namespace {

/// Weighted sums of each number and those at multiples of `step` before and after it.
void weigh(const float* middle, std::size_t count, std::size_t step,
           const std::vector<float>& weights, float* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = weights[0] * middle[i];
  for (std::size_t r = 1; r < weights.size(); ++r) {
    const float weight = weights[r];
    const float* const before = middle - r * step;
    const float* const after = middle + r * step;
    for (std::size_t i = 0; i < count; ++i) out[i] += weight * (before[i] + after[i]);
  }
}

/// Filters `width` adjacent lines: their numbers are in rows, `stride` apart. `padded` is scratch.
void blur_lines(float* values, std::size_t width, std::size_t length, std::size_t stride,
                const std::vector<float>& weights, std::vector<float>& padded) {
  const std::size_t reach = weights.size() - 1;
  padded.resize(width * (length + 2 * reach));
  float* const middle = padded.data() + reach * width;
  // Rows without gaps are one.
  const bool whole = stride == width;
  const std::size_t rows = whole ? 1 : length;
  const std::size_t row = whole ? width * length : width;
  for (std::size_t n = 0; n < rows; ++n) std::copy_n(values + n * stride, row, middle + n * row);
  const float* const last = middle + (length - 1) * width;
  for (std::size_t r = 1; r <= reach; ++r) {
    std::copy_n(middle, width, middle - r * width);
    std::copy_n(last, width, middle + (length - 1 + r) * width);
  }
  for (std::size_t n = 0; n < rows; ++n) {
    weigh(middle + n * row, row, width, weights, values + n * stride);
  }
}

void blur_with(GrayVolume& volume, const std::vector<float>& weights) {
  const auto size = [&](std::size_t a) { return static_cast<std::size_t>(volume.dims[a]); };
  const std::size_t row = size(0);
  const std::size_t layer = row * size(1);
  float* const values = volume.values.data();
  parallel_for(size(2), 1, [&](std::size_t k) {
    std::vector<float> padded;
    float* const first = values + k * layer;
    for (std::size_t j = 0; j < size(1); ++j) {
      blur_lines(first + j * row, 1, row, 1, weights, padded);
    }
    blur_lines(first, row, size(1), row, weights, padded);
  });
  parallel_for(size(1), 1, [&](std::size_t j) {
    std::vector<float> padded;
    blur_lines(values + j * row, row, size(2), layer, weights, padded);
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
  blur_with(volume, shares);
}

}  // namespace reckon
