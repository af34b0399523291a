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

/// Points on a grain's surface, in the body frame. Their order is part of the shape:
/// contact forces of a pair are summed in it, and neighbours on the surface are neighbours in it.
struct SurfaceNodes {
  std::vector<double> x;     ///< [m]
  std::vector<double> y;     ///< [m]
  std::vector<double> z;     ///< [m]
  std::vector<double> area;  ///< tributary area; that of one face on an edge [m^2]

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
  double sieve_size{0};           ///< side of the least square hole that the grain passes [m]
  double elongation{0};           ///< width / length (Zingg 1935)
  double flatness{0};             ///< thickness / width (Zingg 1935)
  double sphericity{0};  ///< area of the sphere of equal volume / surface area (Wadell 1932)
  double convexity{0};   ///< volume / volume of the convex hull
  /// Mean corner radius / largest inscribed radius (Wadell 1932), in three dimensions: corners are
  /// where the sharper principal radius of curvature, seen over a tenth of the equivalent diameter,
  /// is below the inscribed radius. They count fully below three quarters of it, and less and less
  /// up to 0.95 of it; 1 without corners.
  double roundness{0};
};

/// What of a shape is kept in files and in the memory of a run.
enum class ShapeStorage : std::uint8_t {
  full,  ///< the whole grid in single precision, nodes in double precision
  band,  ///< a LevelSetBand, nodes in single precision
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
  ShapeStorage storage{ShapeStorage::full};
};

/// Makes the shape one that is stored as a band: grid and nodes become what the band and single
/// precision hold, so that a run on the whole of them and one on the band give the same bits.
void round_to_band(Shape& shape);

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
  ShapeStorage storage{ShapeStorage::full};
  std::uint64_t band_words{0};  ///< of the LevelSetBand, where there is one

  [[nodiscard]] std::uint64_t values() const {
    return static_cast<std::uint64_t>(dims[0]) * static_cast<std::uint64_t>(dims[1]) *
           static_cast<std::uint64_t>(dims[2]);
  }
  /// What grid, nodes and clusters take [bytes].
  [[nodiscard]] std::uint64_t memory() const;
};
/// (`band_words` stays 0 of a shape without values.)
[[nodiscard]] ShapeOutline outline_of(const Shape& shape);

/// As outline_of, but it does not look at the grid's values, which may still be unchecked:
/// `band_words` stays 0.
[[nodiscard]] ShapeOutline outline_without_grid(const Shape& shape);

/// Groups the nodes, in their order, into runs of at most `per_cluster`, each with a sphere that
/// holds its nodes (rounded outward).
[[nodiscard]] std::vector<NodeCluster> make_clusters(const SurfaceNodes& nodes,
                                                     std::uint32_t per_cluster = nodes_per_cluster);

/// Numbers in double or in single precision. Does not own.
class NumberColumn {
 public:
  NumberColumn() = default;
  NumberColumn(std::span<const double> numbers)  // NOLINT(google-explicit-constructor): like span
      : doubles_{numbers.data()}, size_{numbers.size()} {}
  NumberColumn(std::span<const float> numbers)  // NOLINT(google-explicit-constructor): like span
      : singles_{numbers.data()}, size_{numbers.size()} {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] double operator[](std::size_t n) const {
    return singles_ != nullptr ? double{singles_[n]} : doubles_[n];
  }

 private:
  const double* doubles_{nullptr};
  const float* singles_{nullptr};
  std::size_t size_{0};
};

/// SurfaceNodes as the kernels read them.
struct SurfaceNodesView {
  NumberColumn x;
  NumberColumn y;
  NumberColumn z;
  NumberColumn area;

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] Vec3 position(std::size_t n) const { return {x[n], y[n], z[n]}; }
};

/// A shape as the kernels read it. Does not own.
struct ShapeView {
  LevelSetView level_set;
  SurfaceNodesView nodes;
  std::span<const NodeCluster> clusters;
  MassProperties mass;
  double bounding_radius{0};
  double lipschitz{1};
  double sphere_radius{0};   ///< see Shape [m]
  double mean_node_area{0};  ///< of the nodes that are there [m^2]

  ShapeView() = default;
  ShapeView(const Shape& shape);  // NOLINT(google-explicit-constructor): a view, like span
  /// Without grid and nodes.
  explicit ShapeView(const ShapeOutline& outline);
  void set_nodes(const SurfaceNodesView& these);
};

/// All shapes of a run; a ShapeId is a place in it.
using ShapeLibrary = std::vector<Shape>;

}  // namespace reckon
