// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/paraview_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/vtk_xml.hpp"
#include "reckon/output/grain_fields.hpp"
#include "reckon/output/history.hpp"
#include "reckon/report/run_shapes.hpp"
#include "reckon/results/saved_fields.hpp"

namespace reckon {
namespace {

/// The last step of the history before the last stage that the run came to; zero without stages.
std::uint64_t last_stage_start(const RunFolder& folder) {
  if (!std::filesystem::exists(folder.history())) return 0;
  const HistoryTable table = read_history(folder.own(folder.history()));
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::find(table.header.begin(), table.header.end(), name) -
                                    table.header.begin());
  };
  const std::size_t stage = column("stage");
  const std::size_t step = column("step");
  if (stage == table.header.size() || step == table.header.size()) return 0;
  for (auto row = table.rows.rbegin(); row != table.rows.rend(); ++row) {
    if ((*row)[stage] != table.rows.back()[stage]) {
      return std::strtoull((*row)[step].c_str(), nullptr, 10);
    }
  }
  return 0;
}

std::uint64_t nearest(const std::vector<std::uint64_t>& steps, std::uint64_t wanted) {
  const auto distance = [&](std::uint64_t step) {
    return step > wanted ? step - wanted : wanted - step;
  };
  return *std::min_element(steps.begin(), steps.end(), [&](std::uint64_t a, std::uint64_t b) {
    return distance(a) < distance(b);
  });
}

void write_shape(const std::filesystem::path& path, const DisplayMesh& display) {
  VtkPolyData data;
  data.points = vtk_array("Points", display.mesh.vertices);
  for (const TriangleMesh::Triangle& triangle : display.mesh.triangles) {
    auto& points = data.polygons.connectivity;
    points.insert(points.end(), triangle.begin(), triangle.end());
    data.polygons.offsets.push_back(static_cast<std::int64_t>(points.size()));
  }
  data.point_data = {vtk_array("Normals", display.normals_unit)};
  write_vtp(path, data);
}

/// A block for each shape, by ShapeId: those that no grain has are empty.
void write_shapes(const std::filesystem::path& folder, const std::vector<RunShape>& shapes) {
  std::filesystem::create_directories(folder / "shapes");
  std::vector<VtmBlock> blocks;
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    const std::string file = fmt::format("shapes/{:05}.vtp", s);
    write_shape(folder / file, shapes[s].fine);
    blocks.push_back({shapes[s].name, file});
  }
  write_vtm(folder / "shapes.vtm", blocks);
}

void replace(std::string& text, std::string_view what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at != std::string::npos) text.replace(at, what.size(), by);
}

/// A text as Python reads it: bytes as the system has them in file names, in ASCII.
std::string python_text(std::string_view text) {
  std::string quoted = "os.fsdecode(b\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    const bool plain = code >= 0x20 && code < 0x7f && c != '"' && c != '\\';
    quoted += plain ? std::string(1, c) : fmt::format("\\x{:02x}", code);
  }
  return quoted + "\")";
}

/// The units of the fields as a dictionary of Python.
std::string python_units() {
  std::string units = "{";
  for (const GrainField& field : grain_fields()) {
    if (!field.unit.empty()) units += fmt::format("\"{}\": \"{}\", ", field.name, field.unit);
  }
  return units + "\"displacement\": \"m\", \"rotation\": \"degrees\"}";
}

}  // namespace

ParaviewState write_paraview_state(const RunFolder& folder) {
  const SceneConfig scene = scene_of_run(folder);
  const std::vector<std::uint64_t> saved = folder.field_steps("grains");
  if (saved.empty()) {
    throw Error{{.place = folder.root().string(),
                 .problem = "this run has saved no grains",
                 .reason = {},
                 .fix = "Wait until it has, or run it again."}};
  }
  const RunShapes shapes = read_run_shapes(folder, scene, grains_by_shape(folder));
  const std::filesystem::path target = folder.paraview();
  folder.remove_paraview();
  std::filesystem::create_directories(target);
  if (shapes.missing.empty()) write_shapes(target, shapes.shapes);

  const std::uint64_t start = nearest(saved, last_stage_start(folder));
  std::string text{paraview_state_text()};
  text.erase(0, text.find("# Written by"));  // what it writes is the user's
  replace(text, "@counted_from@", fmt::format("{}", read_fields(folder, start).time));
  replace(text, "@of_stage@",
          start == saved.front() ? std::string{} : ", at which the last stage began");
  replace(text, "@units@", python_units());
  replace(text, "@folder@",
          python_text(std::filesystem::absolute(folder.root()).lexically_normal().string()));
  write_file(target / "state.py", text);
  return {target / "state.py", shapes.shapes.size(), shapes.missing};
}

}  // namespace reckon
