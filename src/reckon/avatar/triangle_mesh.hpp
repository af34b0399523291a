// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// A closed surface made of triangles. Every edge belongs to two triangles, and vertices are
/// counter-clockwise when seen from outside.
struct TriangleMesh {
  using Triangle = std::array<std::uint32_t, 3>;

  std::vector<Vec3> vertices;       ///< [m]
  std::vector<Triangle> triangles;  ///< indices into vertices
};

}  // namespace reckon
