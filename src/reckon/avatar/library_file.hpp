// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "reckon/avatar/provenance.hpp"
#include "reckon/core/id.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// A checksum of all data that the mechanics of a shape depends on (grid, nodes, mass, radius and
/// Lipschitz constant; not name and descriptors). Shapes that act alike have equal digests on every
/// machine, so a checkpoint can detect that its shapes have changed.
[[nodiscard]] std::uint64_t shape_digest(const Shape& shape);

/// Throws Error with `place` in front when a shape's parts do not fit together or a number is out
/// of its range: dims against values, node arrays against each other, everything finite, volume,
/// inertia, radii and spacing positive.
void check_shape(const Shape& shape, const std::string& place);

/// The part of check_shape that needs no grid and no nodes; `values` is the number of grid values.
void check_outline(const ShapeOutline& outline, std::uint64_t values, const std::string& place);

/// Writes a shape library, shape by shape, so that no more than one needs to be in memory: a sealed
/// HDF5 file (core/hdf5_file.hpp) in which all shapes' grids lie behind each other in one dataset
/// and all nodes in four, with a table of where each begins, so that thousands of shapes load fast
/// and any of them can be loaded alone.
///
///   /shape/{name, dims, spacing, origin, first_value, first_node, volume, inertia,
///           bounding_radius, lipschitz, digest}                            one row per shape
///   /descriptor/{length, width, ...}                                       one row per shape
///   /grid/values     signed distances; shape s has first_value[s] ... first_value[s+1] - 1
///   /grid/band       or, where the shapes are stored as bands, the words of those
///   /node/{x, y, z, area}           likewise with first_node; of bands in single precision
///   /provenance/{program, command, source, ...}    how the library was made (provenance.hpp)
///
/// Every dataset has a `unit`. Clusters are not stored: they follow from the nodes.
class LibraryWriter {
 public:
  LibraryWriter(const std::filesystem::path& path, ShapeStorage storage,
                Provenance provenance = {});
  ~LibraryWriter();
  LibraryWriter(const LibraryWriter&) = delete;
  LibraryWriter& operator=(const LibraryWriter&) = delete;

  /// Throws Error when the shape fails check_shape, is stored otherwise, or has the name of one
  /// before it.
  void add(const Shape& shape);
  /// Until then there is no file. Throws Error when there are no shapes.
  void finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes shapes that are all in memory, stored as the first of them is.
void save_library(const std::filesystem::path& path, const ShapeLibrary& library,
                  Provenance provenance = {});

/// Throws Error when a file that is no shape library has this name: it is not replaced.
void require_replaceable_library(const std::filesystem::path& path);

/// All shapes of a library file, of the file library.h5 in a folder, or of a folder of legacy
/// morphology files (morph_1.dat, morph_2.dat, ... in numeric order; see legacy_morphology.hpp), in
/// which a voxel is taken as `legacy_voxel` metres long. Every shape's digest and check_shape are
/// verified.
[[nodiscard]] ShapeLibrary load_library(const std::filesystem::path& file_or_folder,
                                        double legacy_voxel = 1);

/// What is known of a shape before its grid and nodes are read.
struct ShapeSummary {
  std::string name;
  ShapeOutline outline;
  double node_area{0};      ///< sum of the nodes' areas [m^2]
  std::uint64_t digest{0};  ///< see shape_digest
};
[[nodiscard]] ShapeSummary summary_of(const Shape& shape);

/// A library (as load_library takes it) whose shapes are read one by one, when they are needed. A
/// folder of legacy files has no table, so it is read and held as a whole.
class LibrarySource {
 public:
  explicit LibrarySource(const std::filesystem::path& file_or_folder, double legacy_voxel = 1);
  ~LibrarySource();
  LibrarySource(LibrarySource&&) noexcept;
  LibrarySource& operator=(LibrarySource&&) noexcept;

  [[nodiscard]] std::size_t size() const;
  /// Empty for a folder, and for a file of a version before 4.
  [[nodiscard]] Provenance provenance() const;
  /// Whether a version before 4 wrote the file, whose nodes may lie inside the surface and stop
  /// short of sharp edges.
  [[nodiscard]] bool has_early_nodes() const;
  /// A shape without its grid and nodes.
  [[nodiscard]] const Shape& entry(std::size_t shape) const;
  [[nodiscard]] ShapeSummary summary(std::size_t shape) const;
  /// Verifies digest and check_shape.
  [[nodiscard]] Shape read(std::size_t shape) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Some shapes of a library file, in the order asked for.
[[nodiscard]] ShapeLibrary load_shapes(const std::filesystem::path& path,
                                       std::span<const ShapeId> wanted);

/// All shapes without their grids and nodes.
[[nodiscard]] ShapeLibrary entries_of(const LibrarySource& source);

/// The shape of that name. Throws Error when there is none.
[[nodiscard]] const Shape& find_shape(const ShapeLibrary& library, std::string_view name);

}  // namespace reckon
