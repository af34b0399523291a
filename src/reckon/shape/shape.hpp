// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "reckon/math/vec3.hpp"
#include "reckon/shape/level_set.hpp"

namespace reckon {

/// Points on a grain's surface, phi = 0, in the body frame. Their order is part of the shape:
/// contact forces of a pair are summed in it, and neighbours on the surface are neighbours in it.
struct SurfaceNodes {
  std::vector<double> x;     ///< [m]
  std::vector<double> y;     ///< [m]
  std::vector<double> z;     ///< [m]
  std::vector<double> area;  ///< tributary area; sums to the surface area [m^2]

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] Vec3 position(std::size_t n) const { return {x[n], y[n], z[n]}; }
};

/// A run of consecutive nodes and the sphere around them, in the body frame.
struct NodeCluster {
  Vec3 center_body;        ///< [m]
  double radius{0};        ///< [m]
  std::uint32_t first{0};  ///< first node
  std::uint32_t count{0};  ///< number of nodes
};

/// Per unit density, about the centre of mass, in principal axes.
struct MassProperties {
  double volume{0};  ///< [m^3]
  Vec3 inertia;      ///< principal moments of inertia over density [m^5]
};

/// How a grain's form is described in the field. Lengths of the principal-axis bounding box sorted
/// so that length >= width >= thickness.
struct ShapeDescriptors {
  double length{0};               ///< [m]
  double width{0};                ///< [m]
  double thickness{0};            ///< [m]
  double surface_area{0};         ///< [m^2]
  double equivalent_diameter{0};  ///< of the sphere of equal volume [m]
  double elongation{0};           ///< width / length (Zingg 1935)
  double flatness{0};             ///< thickness / width (Zingg 1935)
  double sphericity{0};  ///< area of the sphere of equal volume / surface area (Wadell 1932)
  double convexity{0};   ///< volume / volume of the convex hull
  /// Mean corner radius / largest inscribed radius (Wadell 1932), in three dimensions: corners are
  /// where the sharper principal radius of curvature, seen over a tenth of the equivalent diameter,
  /// is below the inscribed radius; 1 without corners.
  double roundness{0};
};

/// One grain's immutable geometry in its body frame: origin at the centre of mass, axes along the
/// principal axes of inertia. Made by `reckon/avatar`, stored in a shape library.
struct Shape {
  std::string name;
  LevelSet level_set;
  SurfaceNodes nodes;
  std::vector<NodeCluster> clusters;
  MassProperties mass;
  ShapeDescriptors descriptors;
  double bounding_radius{0};  ///< no point with phi < 0 and no node lies farther out [m]
  double lipschitz{1};        ///< see lipschitz_constant
  /// Of a shape that is a sphere, so that contacts between two need no nodes; 0: it is none [m].
  double sphere_radius{0};
};

inline constexpr std::uint32_t nodes_per_cluster = 16;

/// What is known of a shape without its grid and nodes, as plain numbers that ranks can send.
struct ShapeOutline {
  std::array<std::int32_t, 3> dims{0, 0, 0};  ///< of the grid, as in LevelSet
  double spacing{0};                          ///< of the grid [m]
  Vec3 origin_body;                           ///< of the grid [m]
  std::uint64_t nodes{0};                     ///< how many
  MassProperties mass;
  double bounding_radius{0};  ///< [m]
  double lipschitz{1};
  double sphere_radius{0};  ///< see Shape [m]

  [[nodiscard]] std::uint64_t values() const {
    return static_cast<std::uint64_t>(dims[0]) * static_cast<std::uint64_t>(dims[1]) *
           static_cast<std::uint64_t>(dims[2]);
  }
  /// What grid, nodes and clusters take [bytes].
  [[nodiscard]] std::uint64_t memory() const;
};
[[nodiscard]] ShapeOutline outline_of(const Shape& shape);

/// Groups the nodes, in their order, into runs of at most `per_cluster`, each with a sphere that
/// holds its nodes (rounded outward).
[[nodiscard]] std::vector<NodeCluster> make_clusters(const SurfaceNodes& nodes,
                                                     std::uint32_t per_cluster = nodes_per_cluster);

/// A shape as the kernels read it. Does not own.
struct ShapeView {
  LevelSetView level_set;
  std::span<const double> node_x;
  std::span<const double> node_y;
  std::span<const double> node_z;
  std::span<const double> node_area;
  std::span<const NodeCluster> clusters;
  MassProperties mass;
  double bounding_radius{0};
  double lipschitz{1};
  double sphere_radius{0};  ///< see Shape [m]

  [[nodiscard]] Vec3 node(std::size_t n) const { return {node_x[n], node_y[n], node_z[n]}; }

  ShapeView() = default;
  ShapeView(const Shape& shape);  // NOLINT(google-explicit-constructor): a view, like span
  /// Without grid and nodes.
  explicit ShapeView(const ShapeOutline& outline);
};

/// All shapes of a run; a ShapeId is a place in it.
using ShapeLibrary = std::vector<Shape>;

}  // namespace reckon
