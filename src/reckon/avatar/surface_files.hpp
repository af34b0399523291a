// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "reckon/avatar/triangle_mesh.hpp"
#include "reckon/shape/shape.hpp"

namespace reckon {

/// The mesh as STL keeps it, with coordinates in single precision and equal ones welded.
[[nodiscard]] TriangleMesh rounded_to_stl(TriangleMesh mesh);

/// Writes a surface as binary STL, coordinates in metres as float. `title` goes into the header.
void write_stl(const std::filesystem::path& path, const TriangleMesh& mesh,
               const std::string& title);

/// Writes the surface phi = 0 of a shape for ParaView, in the body frame, with point normals from
/// the level set's gradient.
void write_surface_vtp(const std::filesystem::path& path, const Shape& shape);

/// Writes the shape's nodes for ParaView: points with "area", "normal" and "cluster".
void write_nodes_vtp(const std::filesystem::path& path, const Shape& shape);

}  // namespace reckon
