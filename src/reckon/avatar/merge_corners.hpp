// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// What merging did.
struct MergedCorners {
  TriangleMesh mesh;
  std::size_t merged{0};          ///< corners that became another
  double largest_distance{0};     ///< that one of them moved [m]
  std::size_t lost_triangles{0};  ///< triangles of which two corners became one

  /// In a sentence.
  [[nodiscard]] std::string text() const;
};

/// Joins corners that should be one but differ by rounding. Only ends of open edges are looked at,
/// so that fine detail of a closed part of the surface stays as it is. Each of them, in their
/// order, becomes the closest earlier one within `distance` [m]. Without a distance it is 1e-5 of
/// the mesh's size, or 1e-6 of its largest coordinate where that is more: what single precision and
/// six-digit text leave.
[[nodiscard]] MergedCorners merge_corners(const TriangleMesh& mesh,
                                          std::optional<double> distance = {});

}  // namespace reckon
