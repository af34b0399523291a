// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include "reckon/shape/kept_shape.hpp"

namespace reckon::testing {

/// A shape twice: the whole of what a band holds of it, and the band as a run keeps it.
class BandShape {
 public:
  explicit BandShape(const Shape& shape) : whole_{rounded(shape)}, kept_{whole_} {}
  BandShape(const BandShape&) = delete;
  BandShape& operator=(const BandShape&) = delete;

  [[nodiscard]] const Shape& whole() const { return whole_; }
  [[nodiscard]] const KeptShape& kept() const { return kept_; }
  [[nodiscard]] ShapeView view() const { return kept_.view(); }

 private:
  static Shape rounded(Shape shape) {
    round_to_band(shape);
    return shape;
  }

  Shape whole_;
  KeptShape kept_;
};

}  // namespace reckon::testing
