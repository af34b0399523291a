// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>

#include "reckon/avatar/triangle_mesh.hpp"

/// The simplest writers of mesh formats, for reading back.
namespace reckon::test {

template <class T>
void put(std::string& out, T value, bool big_endian = false) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) {
    std::reverse(bytes.begin(), bytes.end());
  }
  out += bytes;
}

inline std::string binary_stl(const TriangleMesh& mesh, std::string header = "") {
  header.resize(80);
  std::string out = header;
  put(out, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    for (int n = 0; n < 3; ++n) put(out, 0.0F);
    for (const std::uint32_t v : t) {
      for (int axis = 0; axis < 3; ++axis) put(out, static_cast<float>(mesh.vertices[v][axis]));
    }
    put(out, std::uint16_t{0});
  }
  return out;
}

inline std::string ascii_stl(const TriangleMesh& mesh, const std::string& end_of_line = "\n") {
  std::ostringstream out;
  out.precision(17);
  out << "solid test part" << end_of_line;
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    out << "  facet normal nan nan nan" << end_of_line << "    outer loop" << end_of_line;
    for (const std::uint32_t v : t) {
      const Vec3& at = mesh.vertices[v];
      out << "      vertex " << at.x << ' ' << at.y << ' ' << at.z << end_of_line;
    }
    out << "    endloop" << end_of_line << "  endfacet" << end_of_line;
  }
  out << "endsolid test part" << end_of_line;
  return out.str();
}

inline std::string obj(const TriangleMesh& mesh) {
  std::ostringstream out;
  out.precision(17);
  out << "# test\no part\n";
  for (const Vec3& v : mesh.vertices) out << "v " << v.x << ' ' << v.y << ' ' << v.z << '\n';
  out << "vt 0 0\nvn 0 0 1\ns off\n";
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  int style = 0;  // takes turns through all ways to write a corner
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    out << 'f';
    for (const std::uint32_t v : t) {
      const std::int64_t index = style % 2 == 0 ? std::int64_t{v} + 1 : std::int64_t{v} - count;
      out << ' ' << index
          << (style % 4 == 0   ? ""
              : style % 4 == 1 ? "/1"
              : style % 4 == 2 ? "//1"
                               : "/1/1");
      ++style;
    }
    out << '\n';
  }
  return out.str();
}

enum class Ply { ascii, little_endian, big_endian };

/// With properties and elements beside those that make the mesh.
inline std::string ply(const TriangleMesh& mesh, Ply format) {
  std::ostringstream header;
  header << "ply\nformat "
         << (format == Ply::ascii           ? "ascii"
             : format == Ply::little_endian ? "binary_little_endian"
                                            : "binary_big_endian")
         << " 1.0\ncomment test\nelement vertex " << mesh.vertices.size()
         << "\nproperty double x\nproperty uchar red\nproperty double y\nproperty double z\n"
         << "property list uchar short tags\nelement camera 2\nproperty float focus\nelement face "
         << mesh.triangles.size()
         << "\nproperty uint8 flags\nproperty list uint8 int32 vertex_indices\nend_header\n";
  std::string out = header.str();
  const bool big = format == Ply::big_endian;
  if (format != Ply::ascii) {
    for (const Vec3& v : mesh.vertices) {
      put(out, v.x, big);
      put(out, std::uint8_t{200}, big);
      put(out, v.y, big);
      put(out, v.z, big);
      put(out, std::uint8_t{2}, big);
      put(out, std::int16_t{-5}, big);
      put(out, std::int16_t{6}, big);
    }
    put(out, 1.5F, big);
    put(out, 2.5F, big);
    for (const TriangleMesh::Triangle& t : mesh.triangles) {
      put(out, std::uint8_t{9}, big);
      put(out, std::uint8_t{3}, big);
      for (const std::uint32_t v : t) put(out, static_cast<std::int32_t>(v), big);
    }
    return out;
  }
  std::ostringstream body;
  body.precision(17);
  for (const Vec3& v : mesh.vertices) body << v.x << " 200 " << v.y << ' ' << v.z << " 2 -5 6\n";
  body << "1.5\n2.5\n";
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    body << "9 3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  }
  return out + body.str();
}

}  // namespace reckon::test
