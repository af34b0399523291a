// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/core/error.hpp"

namespace reckon {

/// For every triangle the part that it belongs to. Triangles that share an edge are in one part;
/// parts are numbered in the order of their first triangles.
[[nodiscard]] std::vector<std::uint32_t> parts_of(const TriangleMesh& mesh);

/// The triangles for which `keep` holds, with the vertices that they use.
[[nodiscard]] TriangleMesh submesh(const TriangleMesh& mesh, const std::vector<bool>& keep);

/// The part that encloses the largest volume, of either sign, and what the others come to.
struct LargestPart {
  TriangleMesh mesh;
  std::size_t others{0};
  double others_volume{0};  ///< the sum of theirs without signs, in parts of the largest
};
[[nodiscard]] LargestPart largest_part(const TriangleMesh& mesh);

/// The same surface, in which no two parts share a corner.
[[nodiscard]] TriangleMesh with_own_corners(const TriangleMesh& mesh);

/// A part of a mesh as a grain, or why it cannot be one.
struct SolidPart {
  TriangleMesh mesh;
  std::optional<Error> fault;
};

/// Every part of a mesh, in order. A part is at fault, with `name` and its number (from 1) as the
/// place, unless it is the closed surface of one solid (require_closed_surface). Throws Error where
/// parts without a fault are not apart: one that lies in another may be a cavity or a second grain,
/// and which cannot be known.
[[nodiscard]] std::vector<SolidPart> separate_solids(const TriangleMesh& mesh,
                                                     const std::string& name);

}  // namespace reckon
