// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/core/vtk_xml.hpp"
#include "reckon/math/rotation.hpp"
#include "reckon/output/fields.hpp"

/// What fields say of grains: a point for each, or its surface.
namespace reckon {

void put_into(const PeriodicCell& cell, FieldsAtStep& fields) {
  fields.cell = cell;
  fields.cell_shift.clear();
  for (GrainState& grain : fields.grains) {
    const Vec3 edges = cell.nearest_image(grain.position - cell.center());
    fields.cell_shift.push_back(cell.shift_of(edges));
    grain.position -= fields.cell_shift.back();
    grain.velocity -= cell.velocity_of(edges);
  }
}

namespace {

/// How many partners each grain touches, and the sum of their forces.
struct TouchingOfGrains {
  std::vector<std::uint32_t> partners;
  std::vector<Vec3> force;  ///< [N]
};
TouchingOfGrains touching_of(const FieldsAtStep& fields) {
  std::vector<std::size_t> row_of_id;
  for (std::size_t row = 0; row < fields.grains.size(); ++row) {
    const std::uint32_t id = fields.grains[row].id.get();
    row_of_id.resize(std::max<std::size_t>(row_of_id.size(), id + 1U));
    row_of_id[id] = row;
  }
  TouchingOfGrains touching{std::vector<std::uint32_t>(fields.grains.size(), 0),
                            std::vector<Vec3>(fields.grains.size())};
  for (const ContactRecord& contact : fields.contacts) {
    const std::size_t row = row_of_id[contact.grain.get()];
    ++touching.partners[row];
    touching.force[row] += contact.force;
    if (contact.with_wall) continue;
    const std::size_t partner = row_of_id[contact.partner];
    ++touching.partners[partner];
    touching.force[partner] -= contact.force;
  }
  return touching;
}

/// What both kinds of files tell of a grain: in doubles where it is a point; pictures of surfaces
/// do not need them, and are the largest files of a run.
template <class Real>
class GrainColumns {
 public:
  GrainColumns(const FieldsAtStep& fields, std::span<const ShapeSummary> shapes, double density)
      : fields_{fields}, shapes_{shapes}, density_{density}, touching_{touching_of(fields)} {}

  void reserve(std::size_t points) {
    for (auto* column : {&equivalent_radius_, &mass_}) column->reserve(points);
    for (auto* column : {&velocity_, &spin_, &force_}) column->reserve(3 * points);
    partners_.reserve(points);
    if (!fields_.ranks.empty()) ranks_.reserve(points);
  }

  /// `points` rows of the grain in this row of the fields.
  void append(std::size_t row, std::size_t points) {
    const GrainState& grain = fields_.grains[row];
    const MassProperties& body = shapes_[grain.shape.get()].outline.mass;
    const Vec3 spin = rotation_matrix(grain.orientation) * grain.angular_velocity_body;
    const double equivalent_radius = std::cbrt(0.75 / std::numbers::pi * body.volume);
    for (std::size_t point = 0; point < points; ++point) {
      equivalent_radius_.push_back(static_cast<Real>(equivalent_radius));
      mass_.push_back(static_cast<Real>(density_ * body.volume));
      append(velocity_, grain.velocity);
      append(spin_, spin);
      append(force_, touching_.force[row]);
      partners_.push_back(touching_.partners[row]);
      if (!fields_.ranks.empty()) ranks_.push_back(fields_.ranks[row]);
    }
  }
  void add_to(std::vector<VtkArray>& arrays) const {
    arrays.push_back(vtk_array("equivalent_radius", equivalent_radius_));
    arrays.push_back(vtk_array("mass", mass_));
    arrays.push_back(vtk_array("velocity", velocity_, 3));
    arrays.push_back(vtk_array("angular_velocity", spin_, 3));
    if (fields_.has_contacts) {
      arrays.push_back(vtk_array("contacts", partners_));
      arrays.push_back(vtk_array("contact_force", force_, 3));
    }
    if (!fields_.ranks.empty()) arrays.push_back(vtk_array("rank", ranks_));
  }

  static void append(std::vector<Real>& to, const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) to.push_back(static_cast<Real>(v[axis]));
  }

 private:
  const FieldsAtStep& fields_;
  std::span<const ShapeSummary> shapes_;
  double density_;
  TouchingOfGrains touching_;
  std::vector<Real> equivalent_radius_;
  std::vector<Real> mass_;
  std::vector<Real> velocity_;
  std::vector<Real> spin_;
  std::vector<Real> force_;
  std::vector<std::uint32_t> partners_;
  std::vector<std::uint32_t> ranks_;
};

}  // namespace

void write_grain_points(const std::filesystem::path& path, const FieldsAtStep& fields,
                        std::span<const ShapeSummary> shapes, double density) {
  GrainColumns<double> columns{fields, shapes, density};
  std::vector<std::uint32_t> id;
  std::vector<std::uint32_t> shape;
  std::vector<std::uint8_t> prescribed;
  std::vector<double> radius;
  std::vector<double> speed;
  std::vector<Vec3> position;
  std::vector<Quaternion> orientation;
  for (std::size_t row = 0; row < fields.grains.size(); ++row) {
    const GrainState& grain = fields.grains[row];
    id.push_back(grain.id.get());
    shape.push_back(grain.shape.get());
    prescribed.push_back(grain.prescribed ? 1 : 0);
    radius.push_back(shapes[grain.shape.get()].outline.bounding_radius);
    speed.push_back(norm(grain.velocity));
    position.push_back(grain.position);
    orientation.push_back(grain.orientation);
    columns.append(row, 1);
  }
  VtkPolyData data;
  data.points = vtk_array("Points", position);
  data.vertices = consecutive_cells(id.size(), 1);
  data.point_data = {vtk_array("id", id),         vtk_array("shape", shape),
                     vtk_array("radius", radius), vtk_array("orientation", orientation),
                     vtk_array("speed", speed),   vtk_array("prescribed", prescribed)};
  columns.add_to(data.point_data);
  if (fields.cell) data.point_data.push_back(vtk_array("cell_shift", fields.cell_shift));
  const std::vector<double> time{fields.time};
  data.field_data = {vtk_array("TimeValue", time),
                     vtk_array("wall_displacement", fields.wall_displacement)};
  write_vtp(path, data);
}

SurfaceSize size_of_surfaces(std::span<const GrainState> grains,
                             std::span<const TriangleMesh> surfaces) {
  // Bytes as the arrays below have them.
  constexpr std::uint64_t of_vertex = 15 * sizeof(float);
  constexpr std::uint64_t of_triangle = 4 * sizeof(std::int64_t) + 3 * sizeof(float);
  SurfaceSize size;
  for (const GrainState& grain : grains) {
    const TriangleMesh& surface = surfaces[grain.shape.get()];
    size.triangles += surface.triangles.size();
    size.bytes += surface.vertices.size() * of_vertex + surface.triangles.size() * of_triangle;
  }
  return size;
}

void write_grain_surfaces(const std::filesystem::path& path, const FieldsAtStep& fields,
                          std::span<const ShapeSummary> shapes, double density,
                          std::span<const TriangleMesh> surfaces) {
  GrainColumns<float> columns{fields, shapes, density};
  std::vector<float> place;
  std::vector<std::uint32_t> id;
  std::vector<std::uint32_t> shape;
  std::vector<float> speed;
  VtkPolyData data;
  std::size_t vertices = 0;
  std::size_t all_triangles = 0;
  for (const GrainState& grain : fields.grains) {
    vertices += surfaces[grain.shape.get()].vertices.size();
    all_triangles += surfaces[grain.shape.get()].triangles.size();
  }
  place.reserve(3 * vertices);
  columns.reserve(vertices);
  id.reserve(all_triangles);
  shape.reserve(all_triangles);
  speed.reserve(all_triangles);
  data.polygons.connectivity.reserve(3 * all_triangles);
  data.polygons.offsets.reserve(all_triangles);
  for (std::size_t row = 0; row < fields.grains.size(); ++row) {
    const GrainState& grain = fields.grains[row];
    const TriangleMesh& surface = surfaces[grain.shape.get()];
    const auto first = static_cast<std::int64_t>(place.size() / 3);
    const Mat3 rotation = rotation_matrix(grain.orientation);
    for (const Vec3& vertex : surface.vertices) {
      GrainColumns<float>::append(place, grain.position + rotation * vertex);
    }
    columns.append(row, surface.vertices.size());
    for (const TriangleMesh::Triangle& triangle : surface.triangles) {
      for (const std::uint32_t corner : triangle) {
        data.polygons.connectivity.push_back(first + corner);
      }
      data.polygons.offsets.push_back(static_cast<std::int64_t>(data.polygons.connectivity.size()));
    }
    const std::size_t triangles = surface.triangles.size();
    id.insert(id.end(), triangles, grain.id.get());
    shape.insert(shape.end(), triangles, grain.shape.get());
    speed.insert(speed.end(), triangles, static_cast<float>(norm(grain.velocity)));
  }
  data.points = vtk_array("Points", place, 3);
  data.cell_data = {vtk_array("id", id), vtk_array("shape", shape), vtk_array("speed", speed)};
  columns.add_to(data.point_data);
  const std::vector<double> times{fields.time};
  data.field_data = {vtk_array("TimeValue", times)};
  write_vtp(path, data);
}

std::vector<TriangleMesh> surface_meshes(std::span<const GrainState> grains,
                                         const ShapeStore::Read& read) {
  std::vector<TriangleMesh> meshes;
  for (const GrainState& grain : grains) {
    meshes.resize(std::max<std::size_t>(meshes.size(), grain.shape.get() + 1U));
    TriangleMesh& mesh = meshes[grain.shape.get()];
    if (mesh.triangles.empty()) mesh = extract_surface(read(grain.shape).level_set);
  }
  return meshes;
}

}  // namespace reckon
