// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// Mean and standard deviation of a property that varies from grain to grain. It follows a beta
/// distribution between the property's bounds, which has exactly these two moments.
struct Spread {
  double mean{0};
  double deviation{0};
};

/// The statistics of a population of sand-like grains, at the three scales of Barrett (1980): form,
/// roundness and roughness. The defaults are a sub-angular quartz sand.
struct GrainStatistics {
  // Size: the diameter of the sphere of equal volume. Log-normal by number of grains, cut off at
  // both ends.
  double median_diameter{1e-3};  ///< before the cut-off [m], > 0
  double log_deviation{0.2};     ///< standard deviation of ln(diameter), in [0, 2]
  double smallest_diameter{0};   ///< [m], >= 0 and < largest_diameter
  double largest_diameter{std::numeric_limits<double>::infinity()};  ///< [m]

  // Form: of the bounding box along the principal axes, length >= width >= thickness.
  Spread elongation{0.78, 0.09};  ///< width / length, in [lowest_ratio, 1]
  Spread flatness{0.80, 0.09};    ///< thickness / width, in [lowest_ratio, 1]

  // Angularity: a grain is cut from an ellipsoid by flat faces, whose edges are then rounded.
  std::uint32_t fewest_faces{10};  ///< in [6, most_faces]
  std::uint32_t most_faces{18};    ///< up to 100; all numbers between are equally likely
  double face_irregularity{0.18};  ///< a face cuts in up to this part of the radius; in [0, 0.5]
  Spread roundness{0.35, 0.1};     ///< corner radius / inscribed radius (Wadell), in [0, 0.95]

  // Roughness: ln(radius) is disturbed by a Gaussian random field on the sphere, isotropic and
  // self-affine: its variance at degree n is proportional to n^-(1 + 2 hurst).
  double roughness{0.025};           ///< root mean square relative to the radius, in [0, 0.2]
  double hurst{0.7};                 ///< Hurst exponent, in [0, 2]; larger is smoother
  std::uint32_t lowest_degree{3};    ///< in [2, highest_degree]
  std::uint32_t highest_degree{20};  ///< up to 100; wavelength = 2 pi radius / degree

  static constexpr double lowest_ratio = 0.3;
  static constexpr double highest_roundness = 0.95;

  /// Throws Error naming the first field that is out of range.
  void validate() const;
};

/// Grain number `index` of a population: closed, star-shaped, free of self-intersections, in its
/// principal frame. It depends only on the arguments. Size, elongation and flatness of the mesh are
/// exactly those drawn; roundness is that of the body before roughness is laid on.
///
/// `frequency` divides the geodesic sphere that carries the surface (20 frequency^2 triangles) and
/// must be at least highest_degree, so that no wavelength gets less than five edges.
///
/// Only operations that IEEE 754 rounds exactly are used, in a fixed order: one seed gives the same
/// bits on every machine.
[[nodiscard]] TriangleMesh generate_grain(const GrainStatistics& statistics, std::uint64_t seed,
                                          std::uint64_t index, std::uint32_t frequency = 24);

}  // namespace reckon
