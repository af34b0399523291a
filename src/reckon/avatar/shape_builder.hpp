// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "reckon/avatar/mesh_mass.hpp"
#include "reckon/avatar/triangle_bvh.hpp"
#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// How finely a shape is sampled. Diameters are those of the sphere of equal volume.
struct ShapeResolution {
  double voxels_per_diameter{20};             ///< >= 10 (Duriez & Bonelli 2021)
  std::optional<double> voxel_size{};         ///< overrides voxels_per_diameter [m]
  double node_spacing{0.1};                   ///< root of a node's mean area, in diameters
  std::optional<std::uint32_t> node_count{};  ///< overrides node_spacing; >= 4
  ShapeStorage storage{ShapeStorage::full};
};

/// How a mesh stands for the surface of a grain, which decides where nodes and the grid's zero lie.
enum class SurfaceKind : std::uint8_t {
  sampled,     ///< found from voxels: nodes lie on the zero surface of the interpolated grid
  polyhedron,  ///< it is the surface: nodes lie on it, its sharp edges and corners
  curved,      ///< its vertices lie on a smooth surface: nodes lie on that (CurvedSurface)
  solid,       ///< the same with sharp edges and corners, which get nodes of their own
};

/// Turns a closed surface into a shape.
///
/// The stored data, and how far its parts agree:
/// - Body frame, volume and inertia are those of the polyhedron itself, exact to rounding. The grid
///   holds the polyhedron's exact signed distances at its vertices, rounded to float, so counting
///   on the grid (grid_properties) gives the same mass up to the discretisation error: O(h^2) at
///   edges, far less on smooth grains. It is compared, and a grid that misses the volume by more
///   than `largest_grid_error` is refused as too coarse.
/// - The zero of the interpolated grid, the surface that contact sees, lies on the true surface on
///   average (remove_interpolation_bias); edges sharper than a voxel are rounded.
/// - Nodes lie on the true surface where that is known (`kind`), else on the grid's zero. Sharp
///   edges and corners of a polyhedron or solid get nodes of their own. Areas are shares of the
///   mesh's area; at edges see tributary_areas.
///
/// `mesh` must be closed and outward, in any frame. Throws Error, with the shape's name as the
/// place, when it has no volume, the resolution is out of range or too coarse for the shape, or the
/// grid would have more than `largest_grid` vertices. Uses all threads; the result does not depend
/// on their number.
[[nodiscard]] Shape build_shape(const TriangleMesh& mesh, const ShapeResolution& resolution,
                                const std::string& name,
                                SurfaceKind kind = SurfaceKind::polyhedron);

inline constexpr double largest_grid_error = 0.05;
inline constexpr double largest_grid = 1e9;  ///< vertices

/// A grid around a mesh, padded by more than two spacings, with exact signed distances.
[[nodiscard]] LevelSet sample_signed_distance(const TriangleBvh& bvh, double spacing);

/// The point on the zero surface of the interpolated grid that is reached from `start` by Newton
/// steps along the gradient, or, where those fail, by bisection along `normal`; |phi| there is at
/// most 1e-12 spacings or rounding. Empty when the surface does not pass within two spacings.
[[nodiscard]] std::optional<Vec3> project_to_surface(const LevelSetView& grid, const Vec3& start,
                                                     const Vec3& normal);

}  // namespace reckon
