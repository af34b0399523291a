// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>

#include "reckon/core/random.hpp"
#include "reckon/scan/from_scan.hpp"
#include "reckon/scan/image_filters.hpp"

namespace reckon {
namespace {

using Colour = std::array<double, 3>;

/// One slice across z, rows from the largest y down, as seen with y upwards.
template <class ColourOf>
void draw(const std::filesystem::path& file, const VoxelDims& dims, ColourOf&& colour_of) {
  std::vector<std::uint8_t> rgb;
  for (std::int32_t j = dims[1] - 1; j >= 0; --j) {
    for (std::int32_t i = 0; i < dims[0]; ++i) {
      for (const double part : colour_of(i, j)) {
        rgb.push_back(static_cast<std::uint8_t>(std::clamp(255 * part, 0.0, 255.0)));
      }
    }
  }
  write_png(file, dims[0], dims[1], rgb);
}

/// A bright colour that neighbours rarely share.
Colour colour_of_label(std::uint32_t label) {
  RandomStream random{1, RandomPurpose::other, label};
  const double hue = 6 * random.uniform();
  const double floor = 0.25 + 0.35 * random.uniform();
  Colour colour{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double distance = std::abs(std::remainder(hue - 2 * static_cast<double>(c), 6.0));
    colour[c] = floor + (1 - floor) * std::clamp(2 - distance, 0.0, 1.0);
  }
  return colour;
}

/// Gray values of a slice as brightness, from its 1 % darkest to its 1 % brightest voxels.
class Brightness {
 public:
  explicit Brightness(const GrayVolume& slice) : gray_{slice} {
    std::vector<float> sorted = slice.values;
    std::sort(sorted.begin(), sorted.end());
    low_ = sorted[sorted.size() / 100];
    high_ = sorted[sorted.size() - 1 - sorted.size() / 100];
  }
  [[nodiscard]] double operator()(std::int32_t i, std::int32_t j) const {
    const double range = high_ > low_ ? high_ - low_ : 1;
    return std::clamp((gray_.values[gray_.index(i, j, gray_.low[2])] - low_) / range, 0.0, 1.0);
  }

 private:
  const GrayVolume& gray_;
  double low_{0};
  double high_{1};
};

/// Whether, in a slice, a voxel's value differs from that of the next along x or y.
template <class Value>
bool on_edge(const Volume<Value>& volume, std::int32_t i, std::int32_t j) {
  const std::int32_t k = volume.low[2];
  const Value here = volume.values[volume.index(i, j, k)];
  return (i + 1 < volume.dims[0] && volume.values[volume.index(i + 1, j, k)] != here) ||
         (j + 1 < volume.dims[1] && volume.values[volume.index(i, j + 1, k)] != here);
}

}  // namespace

void write_slices(const Segmentation& scan, std::int32_t k, const std::filesystem::path& folder) {
  const VoxelDims& dims = scan.raw.dims();
  const Box slice{{0, 0, k}, {dims[0], dims[1], 1}};
  const GrayVolume raw = scan.raw.read(slice);
  const GrayVolume shown = scan.denoised.empty() ? raw : scan.denoised.read(slice);
  const Brightness brightness{shown};
  const auto gray = [&](std::int32_t i, std::int32_t j) {
    const double b = brightness(i, j);
    return Colour{b, b, b};
  };
  const Brightness raw_brightness{raw};
  draw(folder / "slice-scan.png", dims, [&](std::int32_t i, std::int32_t j) {
    const double b = raw_brightness(i, j);
    return Colour{b, b, b};
  });
  if (!scan.denoised.empty()) draw(folder / "slice-denoised.png", dims, gray);
  if (!scan.mask.empty()) {
    const MaskVolume mask = scan.mask.read(slice);
    draw(folder / "slice-solid.png", dims, [&](std::int32_t i, std::int32_t j) {
      return on_edge(mask, i, j) ? Colour{1, 0.45, 0} : gray(i, j);
    });
  }
  if (scan.labels.empty()) return;
  const LabelVolume labels = scan.labels.read(slice);
  draw(folder / "slice-grains.png", dims, [&](std::int32_t i, std::int32_t j) {
    const std::uint32_t label = labels.values[labels.index(i, j, k)];
    if (label == 0) return Colour{0, 0, 0};
    if (on_edge(labels, i, j)) return Colour{0, 0, 0};
    const bool kept = scan.choice.kept.empty() ||
                      std::binary_search(scan.choice.kept.begin(), scan.choice.kept.end(), label);
    const Colour colour = colour_of_label(label);
    const double b = 0.35 + 0.65 * brightness(i, j);
    if (!kept) return Colour{0.3 * b, 0.3 * b, 0.3 * b};
    return Colour{colour[0] * b, colour[1] * b, colour[2] * b};
  });
}

void write_place(const Segmentation& scan, const VoxelDims& voxel,
                 const std::filesystem::path& file) {
  constexpr std::int32_t half = 32;  // of the picture's edge [voxels]
  constexpr std::int32_t enlarged = 5;
  Box box = Box{voxel, {1, 1, 1}}.widened(half, scan.labels.box());
  box.low[2] = voxel[2];
  box.dims[2] = 1;
  const GrayVolume gray = scan.raw.read(box);
  const LabelVolume labels = scan.labels.read(box);
  const Brightness brightness{gray};
  draw(file, {enlarged * box.dims[0], enlarged * box.dims[1], 1},
       [&](std::int32_t u, std::int32_t v) {
         const std::int32_t i = box.low[0] + u / enlarged;
         const std::int32_t j = box.low[1] + v / enlarged;
         const std::int32_t a = std::abs(i - voxel[0]);
         const std::int32_t b = std::abs(j - voxel[1]);
         const bool on_cross = (a == 0 || b == 0) && a + b > 2 && a + b < 7;
         if (on_cross) return Colour{1, 1, 1};
         const double bright = brightness(i, j);
         const std::uint32_t label = labels.values[labels.index(i, j, box.low[2])];
         if (label == 0) return Colour{bright, bright, bright};
         const Colour colour = colour_of_label(label);
         const double b_of = 0.25 + 0.75 * bright;
         return Colour{colour[0] * b_of, colour[1] * b_of, colour[2] * b_of};
       });
}

}  // namespace reckon
