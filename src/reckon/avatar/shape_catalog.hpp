// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "reckon/avatar/library_file.hpp"

namespace reckon {

/// The shapes of several libraries, one library after another.
class ShapeCatalog {
 public:
  /// Returns the library, until the next one is added.
  const LibrarySource& add(const std::filesystem::path& library, double legacy_voxel);

  [[nodiscard]] std::size_t size() const { return first_.back(); }
  [[nodiscard]] ShapeSummary summary(ShapeId shape) const;
  /// Reads one shape from its file.
  [[nodiscard]] Shape read(ShapeId shape) const;

 private:
  struct Place {
    const LibrarySource* library;
    std::size_t shape;
  };
  [[nodiscard]] Place find(ShapeId shape) const;

  std::vector<LibrarySource> libraries_;
  std::vector<std::size_t> first_{0};  // of each library, then the total
};

}  // namespace reckon
