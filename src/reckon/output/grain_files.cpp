// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>
#include <variant>

#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/core/vtk_xml.hpp"
#include "reckon/math/rotation.hpp"
#include "reckon/output/fields.hpp"
#include "reckon/output/grain_fields.hpp"

/// The files of the fields of grains: a point per grain, or its surface.
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

/// The fields that files hold, as arrays of growing length.
template <class Real>
class GrainArrays {
 public:
  GrainArrays(const FieldsAtStep& fields, std::span<const ShapeSummary> shapes, double density,
              std::span<const GrainField> table)
      : fields_{fields}, shapes_{shapes}, density_{density}, touching_{touching_of(fields)} {
    for (const GrainField& field : table) {
      if (is_saved(field, fields)) columns_.push_back({&field, numbers_for(field)});
    }
  }

  void reserve(std::size_t vertices, std::size_t triangles) {
    for (Column& column : columns_) {
      if (column.field->on_surface == OnSurface::nothing) continue;
      const bool at_vertices = column.field->on_surface == OnSurface::vertices;
      const std::size_t count = column.field->components * (at_vertices ? vertices : triangles);
      std::visit([&](auto& numbers) { numbers.reserve(count); }, column.numbers);
    }
  }

  /// The grain in this row of the fields, `times(field)` times.
  template <class Times>
  void append(std::size_t row, Times&& times) {
    const GrainState& state = fields_.grains[row];
    const GrainAtStep grain{state,
                            shapes_[state.shape.get()].outline,
                            density_,
                            touching_.partners[row],
                            touching_.force[row],
                            fields_.ranks.empty() ? 0 : fields_.ranks[row],
                            fields_.cell_shift.empty() ? Vec3{} : fields_.cell_shift[row]};
    for (Column& column : columns_) {
      column.append(column.field->values(grain), times(*column.field));
    }
  }

  /// The arrays of fields that fulfil `wanted`. They refer to this object.
  template <class Wanted>
  void add_to(std::vector<VtkArray>& arrays, Wanted&& wanted) const {
    for (const Column& column : columns_) {
      if (wanted(*column.field)) arrays.push_back(column.array());
    }
  }

 private:
  using Numbers =
      std::variant<std::vector<Real>, std::vector<std::uint32_t>, std::vector<std::uint8_t>>;

  static Numbers numbers_for(const GrainField& field) {
    if (field.numbers == FieldNumbers::count) return std::vector<std::uint32_t>{};
    if (field.numbers == FieldNumbers::flag) return std::vector<std::uint8_t>{};
    return std::vector<Real>{};
  }

  struct Column {
    const GrainField* field;
    Numbers numbers;

    void append(const std::array<double, 4>& values, std::size_t times) {
      std::visit(
          [&](auto& to) {
            using Number = typename std::decay_t<decltype(to)>::value_type;
            for (; times > 0; --times) {
              for (std::size_t n = 0; n < field->components; ++n) {
                to.push_back(static_cast<Number>(values[n]));
              }
            }
          },
          numbers);
    }
    [[nodiscard]] VtkArray array() const {
      return std::visit(
          [&](const auto& all) { return vtk_array(field->name, all, field->components); }, numbers);
    }
  };

  const FieldsAtStep& fields_;
  std::span<const ShapeSummary> shapes_;
  double density_;
  TouchingOfGrains touching_;
  std::vector<Column> columns_;
};

}  // namespace

void write_grain_points(const std::filesystem::path& path, const FieldsAtStep& fields,
                        std::span<const ShapeSummary> shapes, double density,
                        std::span<const GrainField> table) {
  GrainArrays<double> arrays{fields, shapes, density, table};
  std::vector<Vec3> position;
  for (std::size_t row = 0; row < fields.grains.size(); ++row) {
    position.push_back(fields.grains[row].position);
    arrays.append(row, [](const GrainField&) { return std::size_t{1}; });
  }
  VtkPolyData data;
  data.points = vtk_array("Points", position);
  data.vertices = consecutive_cells(position.size(), 1);
  arrays.add_to(data.point_data, [](const GrainField&) { return true; });
  const std::vector<double> time{fields.time};
  data.field_data = {vtk_array("TimeValue", time),
                     vtk_array("wall_displacement", fields.wall_displacement)};
  write_vtp(path, data);
}

void write_grain_points(const std::filesystem::path& path, const FieldsAtStep& fields,
                        std::span<const ShapeSummary> shapes, double density) {
  write_grain_points(path, fields, shapes, density, grain_fields());
}

SurfaceSize size_of_surfaces(std::span<const GrainState> grains,
                             std::span<const TriangleMesh> surfaces) {
  // Bytes as the arrays below have them, of fields of all kinds of runs.
  std::uint64_t of_vertex = 3 * sizeof(float);
  std::uint64_t of_triangle = 4 * sizeof(std::int64_t);
  for (const GrainField& field : grain_fields()) {
    const std::uint64_t bytes = field.components * sizeof(float);
    if (field.on_surface == OnSurface::vertices) of_vertex += bytes;
    if (field.on_surface == OnSurface::triangles) of_triangle += bytes;
  }
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
  GrainArrays<float> arrays{fields, shapes, density, grain_fields()};
  std::vector<float> place;
  VtkPolyData data;
  std::size_t vertices = 0;
  std::size_t all_triangles = 0;
  for (const GrainState& grain : fields.grains) {
    vertices += surfaces[grain.shape.get()].vertices.size();
    all_triangles += surfaces[grain.shape.get()].triangles.size();
  }
  place.reserve(3 * vertices);
  arrays.reserve(vertices, all_triangles);
  data.polygons.connectivity.reserve(3 * all_triangles);
  data.polygons.offsets.reserve(all_triangles);
  for (std::size_t row = 0; row < fields.grains.size(); ++row) {
    const GrainState& grain = fields.grains[row];
    const TriangleMesh& surface = surfaces[grain.shape.get()];
    const auto first = static_cast<std::int64_t>(place.size() / 3);
    const Mat3 rotation = rotation_matrix(grain.orientation);
    for (const Vec3& vertex : surface.vertices) {
      const Vec3 at = grain.position + rotation * vertex;
      for (int axis = 0; axis < 3; ++axis) place.push_back(static_cast<float>(at[axis]));
    }
    arrays.append(row, [&](const GrainField& field) -> std::size_t {
      if (field.on_surface == OnSurface::nothing) return 0;
      return field.on_surface == OnSurface::vertices ? surface.vertices.size()
                                                     : surface.triangles.size();
    });
    for (const TriangleMesh::Triangle& triangle : surface.triangles) {
      for (const std::uint32_t corner : triangle) {
        data.polygons.connectivity.push_back(first + corner);
      }
      data.polygons.offsets.push_back(static_cast<std::int64_t>(data.polygons.connectivity.size()));
    }
  }
  data.points = vtk_array("Points", place, 3);
  const auto carried_by = [](OnSurface carrier) {
    return [carrier](const GrainField& field) { return field.on_surface == carrier; };
  };
  arrays.add_to(data.cell_data, carried_by(OnSurface::triangles));
  arrays.add_to(data.point_data, carried_by(OnSurface::vertices));
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
