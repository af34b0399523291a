// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/surface_files.hpp"

#include <cstring>
#include <limits>
#include <vector>

#include "reckon/avatar/mesh_reader.hpp"
#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/vtk_xml.hpp"

namespace reckon {
namespace {

constexpr std::size_t stl_header = 80;
constexpr std::size_t stl_triangle = 50;  // 12 floats and two unused bytes

template <class Value>
void put(char*& to, Value value) {
  std::memcpy(to, &value, sizeof value);
  to += sizeof value;
}
void put(char*& to, const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) put(to, static_cast<float>(v[axis]));
}

std::vector<Vec3> level_set_normals(const LevelSetView& grid, const std::vector<Vec3>& points) {
  std::vector<Vec3> normals;
  normals.reserve(points.size());
  for (const Vec3& p : points) {
    const auto sample = grid.sample(p);
    normals.push_back(normalized(sample.inside_grid ? sample.gradient_body : p));
  }
  return normals;
}

}  // namespace

TriangleMesh rounded_to_stl(TriangleMesh mesh) {
  for (Vec3& v : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<float>(v[axis]);
  }
  return welded(mesh);
}

void write_stl(const std::filesystem::path& path, const TriangleMesh& mesh,
               const std::string& title) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error{{.place = path.string(),
                 .problem = "has too many triangles for STL",
                 .reason = "the format counts them in 32 bits",
                 .fix = "Export it as VTP."}};
  }
  std::string bytes(stl_header + sizeof(std::uint32_t) + stl_triangle * mesh.triangles.size(), 0);
  // Readers take a file that begins with "solid" for ASCII.
  const std::string header = "binary " + title;
  header.copy(bytes.data(), stl_header);
  char* to = bytes.data() + stl_header;
  put(to, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    put(to, normalized(doubled_area_vector(mesh, t)));
    put(to, a);
    put(to, b);
    put(to, c);
    put(to, std::uint16_t{0});
  }
  write_file(path, bytes);
}

void write_surface_vtp(const std::filesystem::path& path, const Shape& shape) {
  const TriangleMesh mesh = extract_surface(shape.level_set);
  const std::vector<Vec3> normals = level_set_normals(shape.level_set, mesh.vertices);
  VtkPolyData data;
  data.points = vtk_array("Points", mesh.vertices);
  data.point_data = {vtk_array("Normals", normals)};
  for (const auto& t : mesh.triangles) {
    data.polygons.connectivity.insert(data.polygons.connectivity.end(), {t[0], t[1], t[2]});
    data.polygons.offsets.push_back(static_cast<std::int64_t>(data.polygons.connectivity.size()));
  }
  write_vtp(path, data);
}

void write_nodes_vtp(const std::filesystem::path& path, const Shape& shape) {
  std::vector<Vec3> points;
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) points.push_back(shape.nodes.position(n));
  std::vector<std::uint32_t> cluster(points.size());
  for (std::uint32_t c = 0; c < shape.clusters.size(); ++c) {
    for (std::uint32_t n = 0; n < shape.clusters[c].count; ++n) {
      cluster[shape.clusters[c].first + n] = c;
    }
  }
  const std::vector<Vec3> normals = level_set_normals(shape.level_set, points);
  VtkPolyData data;
  data.points = vtk_array("Points", points);
  data.vertices = consecutive_cells(points.size(), 1);
  data.point_data = {vtk_array("area", shape.nodes.area), vtk_array("normal", normals),
                     vtk_array("cluster", cluster)};
  write_vtp(path, data);
}

}  // namespace reckon
