// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "reckon/shape/shape.hpp"

namespace reckon {

/// A shape that takes the memory which its storage stands for, in a program that holds many: one
/// stored as a band lets go of its whole grid.
class KeptShape {
 public:
  KeptShape() = default;
  explicit KeptShape(Shape shape);

  /// Everything but grid, nodes and clusters; these too where the storage is full.
  [[nodiscard]] const Shape& entry() const { return shape_; }
  /// Valid while this object stays where it is.
  [[nodiscard]] ShapeView view() const;
  /// The shape that was given.
  [[nodiscard]] Shape whole() const;

 private:
  using Column = std::vector<float>;

  Shape shape_;
  std::vector<NodeCluster> clusters_;
  std::vector<LevelSetBand::Word> words_;
  LevelSetBand band_;                // of words_
  std::array<Column, 4> columns_{};  // x, y, z, area
};

}  // namespace reckon
