// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// A surface of polygons, as OBJ and PLY files hold it.
struct PolygonMesh {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> corners;        ///< of all faces: indices into vertices
  std::vector<std::size_t> first_corner{0};  ///< of each face, then the number of corners

  void add_face(std::span<const std::uint32_t> face);
  [[nodiscard]] std::size_t faces() const { return first_corner.size() - 1; }
};

/// Splits every face into triangles that use all of its corners, by clipping ears in the projection
/// along the axis that is closest to the face's normal. A face may be concave, have corners on
/// straight sides, and be out of plane as long as its outline does not cross itself in that
/// projection. All decisions are exact. A convex face becomes a fan. Corners that repeat the one
/// before are left out; a face without area becomes triangles without area.
///
/// Throws Error when an outline crosses itself: `place_of` names a face for the message.
[[nodiscard]] TriangleMesh triangulated(
    PolygonMesh mesh, const std::function<std::string(std::size_t face)>& place_of);

}  // namespace reckon
