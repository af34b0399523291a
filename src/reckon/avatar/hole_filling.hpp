// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// A hole that was closed.
struct FilledHole {
  std::size_t edges{0};  ///< around it
  double area{0};        ///< of the triangles that close it [m^2]
};

/// Closes every hole of a surface with triangles between the corners of its border; no corner is
/// added. Of all ways to do so, the one of least area is taken (Barequet & Sharir 1995), which no
/// edge of the surface may cross over; a border of more than 300 corners is clipped ear by ear in
/// its plane instead. The surface must agree which side is out, and no corner may pinch it (two
/// borders through one corner).
///
/// Throws Error, with `name` as the place, for a hole that cannot be closed so.
std::vector<FilledHole> fill_holes(TriangleMesh& mesh, const std::string& name);

}  // namespace reckon
