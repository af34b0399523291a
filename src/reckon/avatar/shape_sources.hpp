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
#include "reckon/core/error.hpp"

namespace reckon {

/// A grain that is yet to be sampled.
struct ShapeSource {
  std::string name;
  /// Makes the closed surface, fine enough for the resolution where the source can choose. Called
  /// in any thread; throws Error when the source is at fault.
  std::function<TriangleMesh(const ShapeResolution&)> surface;
  double sphere_radius{0};                 ///< where it is a sphere [m]
  SurfaceKind kind{SurfaceKind::sampled};  ///< how that surface is to be taken
};

// Sources that choose their own mesh take edges of half a voxel: the chords then lie within
// h^2 / (32 R) of the surface. Nodes and grid do not see them (SurfaceKind::curved), volume and
// inertia do.

/// A mesh file (mesh_reader.hpp), which must pass require_closed_surface.
[[nodiscard]] ShapeSource mesh_file_source(const std::filesystem::path& file,
                                           double unit_in_metres);

/// What may be done to a mesh before it is a closed surface.
struct MeshTreatment {
  bool merge{false};                       ///< join corners that differ by rounding
  std::optional<double> merge_distance{};  ///< within this distance; else see merge_corners [m]
  bool repair{false};                      ///< repair_mesh, which merges too
  bool split{false};                       ///< every part is a grain of its own
};
struct MeshFileSources {
  std::vector<ShapeSource> sources;
  std::vector<std::string> notes;  ///< what was done to the mesh, one sentence each
};
/// A mesh file after that treatment. Parts are named NAME_1, NAME_2, ... if there are several. A
/// file at fault is a source that throws when it is built.
[[nodiscard]] MeshFileSources mesh_file_sources(const std::filesystem::path& file,
                                                double unit_in_metres,
                                                const MeshTreatment& treatment);
/// A spherical-harmonic coefficient file, cut off above `degree` when one is given.
[[nodiscard]] ShapeSource harmonics_file_source(const std::filesystem::path& file,
                                                double unit_in_metres,
                                                std::optional<std::uint32_t> degree);
/// A level-set grid as text (level_set_text.hpp).
[[nodiscard]] ShapeSource level_set_file_source(const std::filesystem::path& file,
                                                double unit_in_metres);
/// An analytic solid: `mesh` makes it for a target edge [m], `extent` is its largest length [m].
[[nodiscard]] ShapeSource solid_source(std::string name, double extent,
                                       std::function<TriangleMesh(double target_edge)> mesh,
                                       SurfaceKind kind = SurfaceKind::solid);
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
/// not fit into memory. Sources at fault are left out; their errors are returned, in the order of
/// the sources. Nothing is written when all are at fault. Throws Error before any work when two
/// names are equal. `on_progress` as in build_library.
[[nodiscard]] std::vector<Error> build_library_file(
    const std::filesystem::path& path, std::span<const ShapeSource> sources,
    const ShapeResolution& resolution, const Provenance& provenance = {},
    const std::function<void(std::size_t done)>& on_progress = {});

}  // namespace reckon
