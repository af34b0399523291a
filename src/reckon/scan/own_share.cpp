// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/own_share.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "reckon/scan/blur.hpp"

namespace reckon {
namespace {

constexpr int deblur_rounds = 5;

constexpr double label_smoothing = 2;  // against staircases [voxels]
constexpr double film_smoothing = 1;   // in each round of the border's motion [voxels]
constexpr int film_rounds = 16;
constexpr float no_solid = 1e-3F;  // smaller shares are not assigned to a grain

GrayVolume blurred(GrayVolume volume, double deviation) {
  blur_volume(volume, deviation);
  return volume;
}

GrayVolume deblurred(const GrayVolume& seen, double blur) {
  GrayVolume sharp = seen;
  for (float& share : sharp.values) share = std::clamp(share, 0.0F, 1.0F);
  for (int round = 0; round < deblur_rounds; ++round) {
    const GrayVolume model = blurred(sharp, blur);
    for (std::size_t v = 0; v < sharp.values.size(); ++v) {
      sharp.values[v] =
          std::clamp(sharp.values[v] + (seen.values[v] - model.values[v]), 0.0F, 1.0F);
    }
  }
  return sharp;
}

/// What of each voxel lies on the grain's side of a border that was smoothed: a ramp one voxel
/// wide.
GrayVolume side(const GrayVolume& part, double smoothing) {
  const auto voxels_per_part = static_cast<float>(std::sqrt(2 * std::numbers::pi) * smoothing);
  GrayVolume inside = part;
  for (float& value : inside.values) {
    value = std::clamp(0.5F + voxels_per_part * (value - 0.5F), 0.0F, 1.0F);
  }
  return inside;
}

void multiply(GrayVolume& volume, const GrayVolume& by) {
  for (std::size_t v = 0; v < volume.values.size(); ++v) volume.values[v] *= by.values[v];
}

}  // namespace

OwnShare own_share(GrayVolume share, const GrayVolume& ownership, double blur) {
  OwnShare own{std::move(share), blurred(ownership, label_smoothing)};
  const bool alone = std::all_of(ownership.values.begin(), ownership.values.end(),
                                 [](float owned) { return owned > 0; });
  if (alone) return own;

  const GrayVolume sharp = deblurred(own.share, blur);
  const GrayVolume solid = blurred(sharp, film_smoothing);
  for (int round = 0; round < film_rounds; ++round) {
    GrayVolume inside = side(own.part, round == 0 ? label_smoothing : film_smoothing);
    multiply(inside, sharp);
    blur_volume(inside, film_smoothing);
    for (std::size_t v = 0; v < inside.values.size(); ++v) {
      if (solid.values[v] > no_solid) own.part.values[v] = inside.values[v] / solid.values[v];
    }
  }

  GrayVolume others = side(own.part, film_smoothing);
  for (float& value : others.values) value = 1 - value;
  multiply(others, sharp);
  blur_volume(others, blur);
  for (std::size_t v = 0; v < others.values.size(); ++v) {
    own.share.values[v] -= others.values[v];
  }
  return own;
}

}  // namespace reckon
