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

/// Turns a closed surface into a shape.
///
/// The stored data, and how far its parts agree:
/// - Body frame, volume and inertia are those of the polyhedron itself, exact to rounding. The grid
///   holds the polyhedron's exact signed distances at its vertices, rounded to float, so counting
///   on the grid (grid_properties) gives the same mass up to the discretisation error: O(h^2) at
///   edges, far less on smooth grains. It is compared, and a grid that misses the volume by more
///   than `largest_grid_error` is refused as too coarse.
/// - Nodes lie on the zero surface of the interpolated grid, which the contact search uses. It lies
///   O(h^2) inside the polyhedron where that is curved. Areas are shares of the polyhedron's area.
///
/// `mesh` must be closed and outward, in any frame. Throws Error, with the shape's name as the
/// place, when it has no volume, the resolution is out of range or too coarse for the shape, or the
/// grid would have more than `largest_grid` vertices. Uses all threads; the result does not depend
/// on their number.
[[nodiscard]] Shape build_shape(const TriangleMesh& mesh, const ShapeResolution& resolution,
                                const std::string& name);

inline constexpr double largest_grid_error = 0.05;
inline constexpr double largest_grid = 1e9;  ///< vertices

/// A grid around a mesh, padded by more than two spacings, with exact signed distances.
[[nodiscard]] LevelSet sample_signed_distance(const TriangleBvh& bvh, double spacing);

/// The point on the zero surface of the interpolated grid that is reached from `start` by Newton
/// steps along the gradient, or, where those fail, by bisection along `normal`; |phi| there is at
/// most 1e-12 spacings or rounding. Empty when the surface does not pass within two spacings.
[[nodiscard]] std::optional<Vec3> project_to_surface(const LevelSetView& grid, const Vec3& start,
                                                     const Vec3& normal);

/// The part of building that needs no mesh distances: nodes, areas, clusters, Lipschitz constant
/// and bounding radius for a grid whose surface is also known as a mesh in the same body frame.
void add_nodes(Shape& shape, const TriangleMesh& body_mesh, const TriangleBvh& bvh,
               std::size_t node_count);

}  // namespace reckon
