// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/generator.hpp"
#include "reckon/avatar/provenance.hpp"
#include "reckon/avatar/shape_builder.hpp"

namespace reckon {

/// A grain that is yet to be sampled.
struct ShapeSource {
  std::string name;
  /// Makes the closed surface, fine enough for the resolution where the source can choose. Called
  /// in any thread; throws Error when the source is at fault.
  std::function<TriangleMesh(const ShapeResolution&)> surface;
  double sphere_radius{0};  ///< where it is a sphere [m]
};

// Sources that choose their own mesh take edges of half a voxel: the chords then lie within
// h^2 / (32 R) of the surface, a fifth of what trilinear interpolation on the grid does to it.

/// A mesh file (mesh_reader.hpp), which must pass require_closed_surface.
[[nodiscard]] ShapeSource mesh_file_source(const std::filesystem::path& file,
                                           double unit_in_metres);
/// A spherical-harmonic coefficient file, cut off above `degree` when one is given.
[[nodiscard]] ShapeSource harmonics_file_source(const std::filesystem::path& file,
                                                double unit_in_metres,
                                                std::optional<std::uint32_t> degree);
/// A level-set grid as text (level_set_text.hpp).
[[nodiscard]] ShapeSource level_set_file_source(const std::filesystem::path& file,
                                                double unit_in_metres);
/// An analytic solid: `mesh` makes it for a target edge [m], `extent` is its largest length [m].
[[nodiscard]] ShapeSource solid_source(std::string name, double extent,
                                       std::function<TriangleMesh(double target_edge)> mesh);
[[nodiscard]] ShapeSource sphere_source(std::string name, double radius);
/// The sphere of this volume [m^3].
[[nodiscard]] ShapeSource equal_sphere_source(std::string name, double volume);
/// Grain `index` of a generated population.
[[nodiscard]] ShapeSource generated_source(const GrainStatistics& statistics, std::uint64_t seed,
                                           std::uint64_t index);

/// Builds all shapes, in parallel over shapes when there are enough of them, else inside each. The
/// library does not depend on the number of threads. `on_progress` is called after every shape with
/// the number done so far, one call at a time. Throws Error before any work when two names are
/// equal; then that of the first source at fault.
[[nodiscard]] ShapeLibrary build_library(
    std::span<const ShapeSource> sources, const ShapeResolution& resolution,
    const std::function<void(std::size_t done)>& on_progress = {});

/// Builds all shapes and writes them to a library file, some at a time, so that the library need
/// not fit into memory. Throws and tells as build_library.
void build_library_file(const std::filesystem::path& path, std::span<const ShapeSource> sources,
                        const ShapeResolution& resolution, const Provenance& provenance = {},
                        const std::function<void(std::size_t done)>& on_progress = {});

}  // namespace reckon
