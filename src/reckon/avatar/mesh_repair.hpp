// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "reckon/avatar/hole_filling.hpp"
#include "reckon/avatar/merge_corners.hpp"
#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// What a repair did to a mesh.
struct MeshRepair {
  MergedCorners corners;             ///< without the mesh
  std::size_t doubled_triangles{0};  ///< that were there before, removed
  std::size_t fragments{0};          ///< loose pieces, removed
  double fragments_area{0};          ///< of the largest of them, in parts of the whole surface
  std::size_t pinched_triangles{0};  ///< at corners where two sheets meet, removed
  std::size_t turned_triangles{0};   ///< that faced the other way
  std::vector<FilledHole> holes;
  double surface_area{0};         ///< of the repaired surface [m^2]
  std::size_t flat_triangles{0};  ///< without area, absorbed by their neighbours

  /// One sentence for each kind of repair; empty when there was nothing to do.
  [[nodiscard]] std::vector<std::string> text() const;
};

/// A loose piece whose area is less than this part of the largest piece's is a fragment.
inline constexpr double largest_fragment = 0.05;

/// Makes a scanned surface closed, as far as that needs no guess about its form:
/// - joins corners that differ by rounding (merge_corners, within `distance` where one is given);
/// - removes triangles that are there twice, and loose fragments;
/// - removes triangles at corners where only corners hold two sheets together, all but the largest;
/// - turns triangles so that neighbours agree, and the volume of each piece is positive;
/// - closes holes (hole_filling.hpp);
/// - takes away triangles without area, by turning the edge that they share with a neighbour.
///
/// Larger pieces stay, all of them. What is left may still be no closed surface, as where it
/// crosses itself: see require_closed_surface. Throws Error, with `name` as the place, where a hole
/// cannot be closed.
MeshRepair repair_mesh(TriangleMesh& mesh, const std::string& name,
                       std::optional<double> distance = {});

}  // namespace reckon
