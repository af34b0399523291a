// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/run_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <span>
#include <variant>

#include "reckon/avatar/shape_statistics.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/output/grain_fields.hpp"
#include "reckon/output/history.hpp"
#include "reckon/report/piece.hpp"
#include "reckon/report/run_shapes.hpp"
#include "reckon/results/run_record.hpp"
#include "reckon/results/run_verdict.hpp"
#include "reckon/results/saved_fields.hpp"
#include "reckon/results/stage_report.hpp"
#include "reckon/simulation/setup.hpp"

namespace reckon {
namespace {

std::string text_of(const RunFolder& folder, const std::filesystem::path& file) {
  return std::filesystem::exists(folder.own(file)) ? read_file(file) : std::string{};
}

double to_number(const std::string& cell) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return value;
}

/// Column by column, with what each means.
void add_history(const RunFolder& folder, const SceneConfig& scene, std::size_t most_rows,
                 Piece& piece) {
  JsonWriter& json = piece.json();
  const std::vector<Wall> walls = make_walls(scene);
  const std::vector<QuantityGroup> groups = quantity_groups(walls);
  HistoryTable table;
  if (std::filesystem::exists(folder.own(folder.history()))) {
    table = read_history(folder.history());
    require_columns(folder.history(), table, groups);
  }
  std::map<std::string, std::string> meanings;
  for (const QuantityGroup& group : groups) {
    for (const HistoryQuantity& quantity : group.quantities) {
      for (const std::string& column : quantity.columns()) meanings[column] = quantity.meaning;
    }
  }
  std::vector<std::uint64_t> rows(table.rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) rows[row] = row;
  rows = spread_steps(rows, most_rows);
  json.value("history_rows", table.rows.size());
  json.begin_array("columns");
  std::vector<double> numbers;
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    json.begin_object();
    json.value("name", table.header[c]);
    json.value("meaning", meanings[table.header[c]]);
    json.end();
    for (const std::uint64_t row : rows) numbers.push_back(to_number(table.rows[row][c]));
  }
  json.end();
  piece.add("history", numbers);
  json.value("verdict", verdict_text(verdict_on(folder, scene, table)));
  json.value("findings", scene.stages.empty() ? std::string{} : stage_report(scene, table));
}

void add_vector(JsonWriter& json, const char* key, const Vec3& v) {
  json.begin_array(key);
  for (int axis = 0; axis < 3; ++axis) json.value({}, v[axis]);
  json.end();
}

void add_walls(const SceneConfig& scene, JsonWriter& json) {
  json.begin_array("walls");
  for (const Wall& wall : make_walls(scene)) {
    json.begin_object();
    json.value("name", wall.name);
    json.value("mould", scene.membrane && scene.membrane->mould == wall.name);
    if (const auto* plane = std::get_if<PlaneSurface>(&wall.surface)) {
      add_vector(json, "point", plane->point);
      add_vector(json, "normal", plane->normal_unit);
    } else if (const auto* cylinder = std::get_if<CylinderSurface>(&wall.surface)) {
      add_vector(json, "point", cylinder->point);
      add_vector(json, "axis", cylinder->axis_unit);
      json.value("radius", cylinder->radius);
    } else if (const auto* ledge = std::get_if<LedgeSurface>(&wall.surface)) {
      add_vector(json, "point", ledge->point);  // not drawn: it would hide the grains
    }
    json.end();
  }
  json.end();
}

/// Surfaces of several shapes in sequence, with numbers as short as a picture allows.
struct PackedMeshes {
  std::vector<std::int16_t> position;  ///< in units of the shape's `extent` / 32767
  std::vector<std::int8_t> normal;     ///< in units of 1/127
  std::vector<std::uint16_t> index;

  void add(const DisplayMesh& display, double extent) {
    const auto pack = [](double value, double most) { return std::lround(value * most); };
    for (const Vec3& vertex : display.mesh.vertices) {
      for (int axis = 0; axis < 3; ++axis) {
        position.push_back(static_cast<std::int16_t>(pack(vertex[axis] / extent, 32767)));
      }
    }
    for (const Vec3& unit : display.normals_unit) {
      for (int axis = 0; axis < 3; ++axis) {
        normal.push_back(static_cast<std::int8_t>(pack(unit[axis], 127)));
      }
    }
    for (const TriangleMesh::Triangle& triangle : display.mesh.triangles) {
      for (const std::uint32_t corner : triangle) {
        index.push_back(static_cast<std::uint16_t>(corner));
      }
    }
  }
  void hand_over(Piece& piece, const std::string& name) const {
    piece.add(name + "_position", position, 3);
    piece.add(name + "_normal", normal, 3);
    piece.add(name + "_index", index, 3);
  }
};

/// The quantities by which the page can colour grains, except those that it computes itself.
void add_fields(JsonWriter& json) {
  json.begin_array("fields");
  for (const GrainField& field : grain_fields()) {
    if (field.label.empty()) continue;
    json.begin_object();
    json.value("name", field.name);
    json.value("label", field.label);
    json.value("unit", field.unit);
    json.value("components", field.components);
    json.value("whole", field.numbers != FieldNumbers::real);
    json.value("needs_contacts", field.needs_contacts);
    json.end();
  }
  json.end();
}

double extent_of(const DisplayMesh& display) {
  double extent = 0;
  for (const Vec3& vertex : display.mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) extent = std::max(extent, std::abs(vertex[axis]));
  }
  return extent;
}

void add_shapes(const RunShapes& shapes, Piece& piece) {
  JsonWriter& json = piece.json();
  json.value("shapes_missing", shapes.missing);
  json.begin_array("measures");
  for (const ShapeMeasure& measure : shape_measures()) json.value(measure.name);
  json.end();
  PackedMeshes fine;
  PackedMeshes coarse;
  json.begin_array("shapes");
  for (std::size_t s = 0; s < shapes.shapes.size(); ++s) {
    const RunShape& shape = shapes.shapes[s];
    const double extent = std::max(extent_of(shape.fine), extent_of(shape.coarse));
    json.begin_object();
    json.value("name", shape.name);
    const auto count = shapes.grains.find(static_cast<std::uint32_t>(s));
    json.value("grains", count == shapes.grains.end() ? 0 : count->second);
    json.value("volume", shape.volume);
    json.value("extent", extent);
    json.value("vertices", shape.fine.mesh.vertices.size());
    json.value("triangles", shape.fine.mesh.triangles.size());
    json.value("coarse_vertices", shape.coarse.mesh.vertices.size());
    json.value("coarse_triangles", shape.coarse.mesh.triangles.size());
    json.begin_array("measures");
    for (const double measure : shape.measures) json.value({}, measure);
    json.end();
    json.end();
    if (extent > 0) {
      fine.add(shape.fine, extent);
      coarse.add(shape.coarse, extent);
    }
  }
  json.end();
  fine.hand_over(piece, "fine");
  coarse.hand_over(piece, "coarse");
}

}  // namespace

std::vector<std::uint64_t> spread_steps(const std::vector<std::uint64_t>& steps, std::size_t most) {
  if (steps.size() <= most || most == 0) return most == 0 ? std::vector<std::uint64_t>{} : steps;
  if (most == 1) return {steps.back()};
  std::vector<std::uint64_t> chosen;
  for (std::size_t n = 0; n < most; ++n) {
    chosen.push_back(steps[n * (steps.size() - 1) / (most - 1)]);
  }
  return chosen;
}

RunPieces::RunPieces(RunFolder folder, PageLimits limits)
    : folder_{std::move(folder)}, limits_{limits} {}

std::vector<std::uint64_t> RunPieces::frame_steps() const {
  return spread_steps(folder_.field_steps("grains"), limits_.frames);
}

void RunPieces::read_shapes(const SceneConfig& scene) {
  const GrainsByShape grains = grains_by_shape(folder_);
  if (!shapes_ || shapes_->grains != grains) shapes_ = read_run_shapes(folder_, scene, grains);
}

std::string RunPieces::head(const std::vector<std::uint64_t>& left_out) {
  const SceneConfig scene = scene_of_run(folder_);
  Piece piece;
  JsonWriter& json = piece.json();
  std::filesystem::path root = std::filesystem::absolute(folder_.root()).lexically_normal();
  if (!root.has_filename()) root = root.parent_path();
  json.value("name", root.filename().string());
  json.value("title", scene.title);
  json.value("density", scene.material.density);
  json.begin_array("stages");
  for (const StageConfig& stage : scene.stages) json.value(stage.name);
  json.end();
  json.value("record", text_of(folder_, folder_.json()));
  json.value("performance", text_of(folder_, folder_.performance()));
  json.value("scene", text_of(folder_, folder_.scene()));
  json.value("resolved", text_of(folder_, folder_.resolved()));
  json.value("log", text_of(folder_, folder_.log()));
  add_history(folder_, scene, limits_.history_rows, piece);
  add_walls(scene, json);
  json.value("cell", scene.cell.has_value());

  const std::vector<std::uint64_t> all = folder_.field_steps("grains");
  json.value("saved_frames", all.size());
  json.begin_array("frames");
  for (const std::uint64_t step : spread_steps(all, limits_.frames)) {
    if (std::find(left_out.begin(), left_out.end(), step) == left_out.end()) json.value({}, step);
  }
  json.end();
  add_fields(json);
  read_shapes(scene);
  add_shapes(*shapes_, piece);
  return piece.finish();
}

std::string RunPieces::frame(std::uint64_t step) {
  const SavedFields fields = read_fields(folder_, step, grain_fields());
  if (!shapes_) read_shapes(scene_of_run(folder_));
  for (const SavedGrain& grain : fields.grains) {
    if (shapes_->shapes.empty() || grain.shape.get() < shapes_->shapes.size()) continue;
    throw Error{{.place = (folder_.root() / RunFolder::field_name("grains", step)).string(),
                 .problem = "this file of fields contradicts the run",
                 .reason = fmt::format("grain {} is said to have shape {} of {}", grain.id.get(),
                                       grain.shape.get(), shapes_->shapes.size()),
                 .fix = {}}};
  }
  std::vector<std::uint32_t> id;
  std::vector<std::uint32_t> shape;
  std::vector<float> position;
  std::vector<float> orientation;
  std::vector<float> radius;
  std::vector<float> equivalent_radius;
  std::vector<float> cell_shift;
  const auto append = [](std::vector<float>& to, const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) to.push_back(static_cast<float>(v[axis]));
  };
  for (const SavedGrain& grain : fields.grains) {
    id.push_back(grain.id.get());
    shape.push_back(grain.shape.get());
    append(position, grain.position);
    const Quaternion& q = grain.orientation;
    for (const double part : {q.w, q.x, q.y, q.z}) orientation.push_back(static_cast<float>(part));
    radius.push_back(static_cast<float>(grain.radius));
    equivalent_radius.push_back(static_cast<float>(grain.equivalent_radius));
    if (!fields.cell_corners.empty()) append(cell_shift, grain.cell_shift);
  }
  std::vector<std::uint32_t> ends;  // rows of two grains, or of a grain and the number of a wall
  std::vector<float> force;
  std::vector<float> branch;
  std::vector<float> deepest;
  std::vector<std::uint16_t> nodes;
  std::size_t pairs = 0;
  const auto row_of = [&](std::uint32_t wanted) {
    return static_cast<std::uint32_t>(std::lower_bound(id.begin(), id.end(), wanted) - id.begin());
  };
  for (const ContactRecord& contact : fields.contacts) {
    if (!contact.with_wall) ++pairs;
    ends.push_back(row_of(contact.grain.get()));
    ends.push_back(contact.with_wall ? contact.partner : row_of(contact.partner));
    append(force, contact.force);
    append(branch, contact.to - contact.from);
    deepest.push_back(static_cast<float>(contact.deepest));
    nodes.push_back(static_cast<std::uint16_t>(std::min(contact.touching, 65535U)));
  }
  std::vector<float> walls;
  for (const Vec3& displacement : fields.wall_displacement) append(walls, displacement);

  std::vector<float> membrane;
  for (const Vec3& place : fields.membrane_places) append(membrane, place);
  std::vector<float> cell;
  for (const Vec3& corner : fields.cell_corners) append(cell, corner);

  Piece piece;
  piece.json().value("step", fields.step);
  piece.json().value("time", fields.time);
  piece.json().value("has_contacts", fields.has_contacts);
  piece.json().value("pairs", pairs);
  piece.add("id", id);
  piece.add("shape", shape);
  piece.add("position", position, 3);
  piece.add("orientation", orientation, 4);
  piece.add("radius", radius);
  piece.add("equivalent_radius", equivalent_radius);
  for (const SavedField& field : fields.shown) {
    piece.add(field.name, std::vector<float>(field.numbers.begin(), field.numbers.end()),
              field.components);
  }
  piece.add("cell_shift", cell_shift, 3);
  piece.add("ends", ends, 2);
  piece.add("force", force, 3);
  piece.add("branch", branch, 3);
  piece.add("deepest", deepest);
  piece.add("nodes", nodes);
  piece.add("wall_displacement", walls, 3);
  piece.add("membrane_position", membrane, 3);
  piece.add("membrane_corners", fields.membrane_corners, 3);
  piece.add("cell_corners", cell, 3);
  return piece.finish();
}

}  // namespace reckon
