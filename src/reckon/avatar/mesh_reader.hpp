// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "reckon/avatar/triangle_mesh.hpp"

namespace reckon {

/// Reads a surface from an STL, OBJ or PLY file, by the extension of the file. Coordinates are
/// multiplied by `unit_in_metres`. Throws Error naming the file and the line or byte offset. The
/// mesh is welded (below) but not checked to be closed: see require_closed_surface.
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& path, double unit_in_metres);

// The same from a file's bytes, in the file's own unit; `name` is for messages. Whatever the bytes
// are, the answer is a mesh with finite vertices and valid indices, or an Error: no number in the
// input is trusted before it is checked against the input's size.

/// Binary or ASCII, detected from the content: many binary files begin with "solid" as well. Stored
/// normals are ignored; the order of the vertices gives the outer side.
[[nodiscard]] TriangleMesh parse_stl(std::string_view bytes, const std::string& name);

/// Reads v and f lines, which a backslash at the end of a line continues; polygons become triangles
/// (polygon_mesh.hpp), negative indices count back from the last vertex. Texture, normals, groups,
/// materials, lines and points are skipped.
[[nodiscard]] TriangleMesh parse_obj(std::string_view bytes, const std::string& name);

/// ASCII and binary of either byte order, with any elements and properties beside the vertices'
/// x, y, z and the faces' vertex_indices; polygons become triangles (polygon_mesh.hpp).
[[nodiscard]] TriangleMesh parse_ply(std::string_view bytes, const std::string& name);

/// Merges vertices with equal coordinates, which STL repeats for every triangle and other formats
/// repeat along texture seams. Drops triangles of which two corners fall together, and vertices
/// that no triangle uses.
[[nodiscard]] TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace reckon
