// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/shape/kept_shape.hpp"

#include <utility>

namespace reckon {
namespace {

template <class Nodes>
auto columns_of(Nodes& nodes) {
  return std::array{&nodes.x, &nodes.y, &nodes.z, &nodes.area};
}

}  // namespace

KeptShape::KeptShape(Shape shape) : shape_{std::move(shape)} {
  if (shape_.storage == ShapeStorage::full) return;
  words_ = encode_band(shape_.level_set);
  band_ = {shape_.level_set.dims, shape_.level_set.spacing, words_};
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const std::vector<double>& numbers = *columns_of(shape_.nodes)[c];
    columns_[c].reserve(numbers.size());
    for (const double number : numbers) columns_[c].push_back(static_cast<float>(number));
  }
  clusters_ = std::move(shape_.clusters);
  shape_.clusters = {};
  shape_.nodes = {};
  shape_.level_set.values = {};
}

ShapeView KeptShape::view() const {
  ShapeView view{shape_};
  if (shape_.storage == ShapeStorage::full) return view;
  view.level_set.band = &band_;
  const auto column = [&](std::size_t c) { return std::span<const float>{columns_[c]}; };
  view.set_nodes({column(0), column(1), column(2), column(3)});
  view.clusters = clusters_;
  return view;
}

Shape KeptShape::whole() const {
  Shape shape = shape_;
  if (shape.storage == ShapeStorage::full) return shape;
  decode_band(words_, shape.level_set);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    columns_of(shape.nodes)[c]->assign(columns_[c].begin(), columns_[c].end());
  }
  shape.clusters = clusters_;
  return shape;
}

}  // namespace reckon
