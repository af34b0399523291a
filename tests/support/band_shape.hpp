// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "reckon/shape/shape.hpp"

namespace reckon::testing {

/// A shape twice: the whole of what a band holds of it, and the band as a run keeps it.
class BandShape {
 public:
  explicit BandShape(Shape shape) : whole_{std::move(shape)} {
    round_to_band(whole_);
    words_ = encode_band(whole_.level_set);
    band_ = {whole_.level_set.dims, whole_.level_set.spacing, words_};
    const SurfaceNodes& nodes = whole_.nodes;
    columns_ = {singles(nodes.x), singles(nodes.y), singles(nodes.z), singles(nodes.area)};
  }
  BandShape(const BandShape&) = delete;
  BandShape& operator=(const BandShape&) = delete;

  [[nodiscard]] const Shape& whole() const { return whole_; }
  [[nodiscard]] ShapeView view() const {
    ShapeView view{whole_};
    view.level_set.values = {};
    view.level_set.band = &band_;
    const auto column = [&](std::size_t c) { return std::span<const float>{columns_[c]}; };
    view.nodes = {column(0), column(1), column(2), column(3)};
    return view;
  }

 private:
  static std::vector<float> singles(const std::vector<double>& numbers) {
    std::vector<float> rounded;
    for (const double number : numbers) rounded.push_back(static_cast<float>(number));
    return rounded;
  }

  Shape whole_;
  std::vector<LevelSetBand::Word> words_;
  LevelSetBand band_;
  std::array<std::vector<float>, 4> columns_;
};

}  // namespace reckon::testing
