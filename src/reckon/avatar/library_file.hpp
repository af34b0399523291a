// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "reckon/core/id.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// A number that stands for all that the mechanics of a shape depends on (grid, nodes, mass, radius
/// and Lipschitz constant; not name and descriptors). Shapes that act alike have equal digests on
/// every machine, so a checkpoint can tell whether its shapes are still the same.
[[nodiscard]] std::uint64_t shape_digest(const Shape& shape);

/// Throws Error with `place` in front when a shape's parts do not fit together or a number is out
/// of its range: dims against values, node arrays against each other, everything finite, volume,
/// inertia, radii and spacing positive.
void check_shape(const Shape& shape, const std::string& place);

/// Writes a shape library: a sealed HDF5 file (core/hdf5_file.hpp) in which all shapes' grids lie
/// behind each other in one dataset and all nodes in four, with a table of where each begins, so
/// that thousands of shapes load fast and any of them can be loaded alone.
///
///   /shape/{name, dims, spacing, origin, first_value, first_node, volume, inertia,
///           bounding_radius, lipschitz, digest}                            one row per shape
///   /descriptor/{length, width, ...}                                       one row per shape
///   /grid/values     signed distances; shape s has first_value[s] ... first_value[s+1] - 1
///   /node/{x, y, z, area}           likewise with first_node
///
/// Every dataset has a `unit`. Clusters are not stored: they follow from the nodes. Throws Error
/// when the library is empty, two shapes share a name, or a shape fails check_shape.
void save_library(const std::filesystem::path& path, const ShapeLibrary& library);

/// All shapes of a library file, or of a folder of legacy morphology files (morph_1.dat,
/// morph_2.dat, ... in numeric order; see legacy_morphology.hpp), in which a voxel is taken as
/// `legacy_voxel` metres long. Every shape's digest and check_shape are verified.
[[nodiscard]] ShapeLibrary load_library(const std::filesystem::path& path, double legacy_voxel = 1);

/// Some shapes of a library file, in the order asked for.
[[nodiscard]] ShapeLibrary load_shapes(const std::filesystem::path& path,
                                       std::span<const ShapeId> wanted);

/// The shape of that name. Throws Error when there is none.
[[nodiscard]] const Shape& find_shape(const ShapeLibrary& library, std::string_view name);

}  // namespace reckon
