// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/shape_catalog.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reckon/core/error.hpp"

namespace reckon {

const LibrarySource& ShapeCatalog::add(const std::filesystem::path& library, double legacy_voxel) {
  libraries_.emplace_back(library, legacy_voxel);
  first_.push_back(first_.back() + libraries_.back().size());
  return libraries_.back();
}

ShapeCatalog::Place ShapeCatalog::find(ShapeId shape) const {
  if (shape.get() >= size()) {
    throw Error{{.problem = fmt::format("there is no shape {}", shape.get()),
                 .reason = fmt::format("the libraries hold {}, counted from 0", size()),
                 .fix = "reckon grains info lists what a library holds."}};
  }
  const auto next = std::upper_bound(first_.begin(), first_.end(), shape.get());
  const auto library = static_cast<std::size_t>(next - first_.begin()) - 1;
  return {&libraries_[library], shape.get() - first_[library]};
}

ShapeSummary ShapeCatalog::summary(ShapeId shape) const {
  const Place place = find(shape);
  return place.library->summary(place.shape);
}

Shape ShapeCatalog::read(ShapeId shape) const {
  const Place place = find(shape);
  return place.library->read(place.shape);
}

}  // namespace reckon
