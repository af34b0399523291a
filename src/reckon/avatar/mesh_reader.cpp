// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/mesh_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {

TriangleMesh read_mesh(const std::filesystem::path& path, double unit_in_metres) {
  const std::string name = path.string();
  if (!(unit_in_metres > 0) || !std::isfinite(unit_in_metres)) {
    throw Error{{.place = name,
                 .problem = "has no usable length unit",
                 .reason = std::to_string(unit_in_metres) + " m",
                 .fix = "Give a unit above zero, such as 0.001 for millimetres."}};
  }
  const std::string extension = lower_case(path.extension().string());
  const auto parse = extension == ".stl"   ? parse_stl
                     : extension == ".obj" ? parse_obj
                     : extension == ".ply" ? parse_ply
                                           : nullptr;
  if (parse == nullptr) {
    throw Error{{.place = name,
                 .problem = "is not a mesh format that can be read",
                 .reason = "the extension is " + in_quotes(extension),
                 .fix = "Give a file that ends in .stl, .obj or .ply."}};
  }
  TriangleMesh mesh = parse(read_file(path), name);
  for (Vec3& vertex : mesh.vertices) vertex *= unit_in_metres;
  return mesh;
}

TriangleMesh welded(const TriangleMesh& mesh) {
  const std::size_t count = mesh.vertices.size();
  const auto key = [&](std::uint32_t v) {
    const Vec3& at = mesh.vertices[v];
    return std::tie(at.x, at.y, at.z);
  };
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return key(a) != key(b) ? key(a) < key(b) : a < b;
  });
  std::vector<std::uint32_t> first_equal(count);  // the lowest vertex at the same place
  for (std::size_t n = 0; n < count; ++n) {
    const bool same = n > 0 && key(order[n]) == key(order[n - 1]);
    first_equal[order[n]] = same ? first_equal[order[n - 1]] : order[n];
  }

  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> renumbered(count, unused);
  TriangleMesh result;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    TriangleMesh::Triangle merged{first_equal[triangle[0]], first_equal[triangle[1]],
                                  first_equal[triangle[2]]};
    if (merged[0] == merged[1] || merged[1] == merged[2] || merged[2] == merged[0]) continue;
    for (std::uint32_t& v : merged) {
      if (renumbered[v] == unused) {
        renumbered[v] = static_cast<std::uint32_t>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[v]);
      }
      v = renumbered[v];
    }
    result.triangles.push_back(merged);
  }
  return result;
}

}  // namespace reckon
