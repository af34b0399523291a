// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "grains_parts.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/io/human.hpp"
#include "reckon/io/json_writer.hpp"

namespace reckon::app {
namespace {

std::uint64_t memory_of(const Shape& shape) { return outline_of(shape).memory(); }

/// Metres in the unit that suits most grains of a library, so that a column can be compared.
struct LengthUnit {
  const char* name;
  double metres;
};
LengthUnit unit_for(const std::vector<const Shape*>& shapes) {
  std::vector<double> diameters;
  diameters.reserve(shapes.size());
  for (const Shape* shape : shapes) diameters.push_back(shape->descriptors.equivalent_diameter);
  const auto middle = diameters.begin() + static_cast<std::ptrdiff_t>(diameters.size() / 2);
  std::nth_element(diameters.begin(), middle, diameters.end());
  if (*middle < 1e-4) return {"um", 1e-6};
  if (*middle < 1) return {"mm", 1e-3};
  return {"m", 1};
}

void print_table(const std::vector<const Shape*>& shapes) {
  const LengthUnit unit = unit_for(shapes);
  std::size_t width = 5;
  for (const Shape* shape : shapes) width = std::max(width, shape->name.size());
  fmt::print(
      "{:<{}} {:>10} {:>8} {:>8} {:>8} {:>8} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>13} {:>9}\n",
      "name", width, fmt::format("vol {}^3", unit.name), fmt::format("d {}", unit.name),
      fmt::format("L {}", unit.name), fmt::format("W {}", unit.name),
      fmt::format("T {}", unit.name), "W/L", "T/W", "spher.", "convex", "round.", "nodes", "grid",
      "memory");
  const double m = unit.metres;
  for (const Shape* shape : shapes) {
    const ShapeDescriptors& d = shape->descriptors;
    const auto& dims = shape->level_set.dims;
    fmt::print(
        "{:<{}} {:>10.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>6.3f} {:>6.3f} {:>6.3f} {:>6.3f} "
        "{:>6.3f} {:>6} {:>13} {:>9}\n",
        shape->name, width, shape->mass.volume / (m * m * m), d.equivalent_diameter / m,
        d.length / m, d.width / m, d.thickness / m, d.elongation, d.flatness, d.sphericity,
        d.convexity, d.roundness, shape->nodes.size(),
        fmt::format("{}x{}x{}", dims[0], dims[1], dims[2]), human_bytes(memory_of(*shape)));
  }
}

void print_summary(const std::vector<const Shape*>& shapes) {
  const LengthUnit unit = unit_for(shapes);
  std::uint64_t memory = 0;
  std::uint64_t nodes = 0;
  for (const Shape* shape : shapes) {
    memory += memory_of(*shape);
    nodes += shape->nodes.size();
  }
  const auto range = [&](const char* what, double scale,
                         const std::function<double(const ShapeDescriptors&)>& value) {
    double low = value(shapes.front()->descriptors);
    double high = low;
    double mean = 0;
    for (const Shape* shape : shapes) {
      const double v = value(shape->descriptors);
      low = std::min(low, v);
      high = std::max(high, v);
      mean += v / static_cast<double>(shapes.size());
    }
    fmt::print("  {:<24} {:>9.4g} {:>9.4g} {:>9.4g}\n", what, low / scale, mean / scale,
               high / scale);
  };
  fmt::print("\n{} {}, {} nodes, {} in memory, checksums good\n", human_count(shapes.size()),
             shapes.size() == 1 ? "grain" : "grains", human_count(nodes), human_bytes(memory));
  if (shapes.size() == 1) return;
  fmt::print("  {:<24} {:>9} {:>9} {:>9}\n", "", "least", "mean", "most");
  range(fmt::format("diameter {}", unit.name).c_str(), unit.metres,
        [](const auto& d) { return d.equivalent_diameter; });
  range("elongation W/L", 1, [](const auto& d) { return d.elongation; });
  range("flatness T/W", 1, [](const auto& d) { return d.flatness; });
  range("sphericity", 1, [](const auto& d) { return d.sphericity; });
  range("convexity", 1, [](const auto& d) { return d.convexity; });
  range("roundness", 1, [](const auto& d) { return d.roundness; });
}

std::string as_json(const std::string& file, const std::vector<const Shape*>& shapes) {
  JsonWriter json;
  json.begin_object();
  json.value("file", file);
  json.value("checksums_good", true);
  json.begin_array("grains");
  for (const Shape* shape : shapes) {
    const ShapeDescriptors& d = shape->descriptors;
    json.begin_object();
    json.value("name", shape->name);
    json.value("digest", fmt::format("{:016x}", shape_digest(*shape)));
    json.value("volume_m3", shape->mass.volume);
    json.begin_array("principal_inertia_over_density_m5");
    for (int axis = 0; axis < 3; ++axis) json.value({}, shape->mass.inertia[axis]);
    json.end();
    json.value("surface_area_m2", d.surface_area);
    json.value("equivalent_diameter_m", d.equivalent_diameter);
    json.value("length_m", d.length);
    json.value("width_m", d.width);
    json.value("thickness_m", d.thickness);
    json.value("elongation", d.elongation);
    json.value("flatness", d.flatness);
    json.value("sphericity", d.sphericity);
    json.value("convexity", d.convexity);
    json.value("roundness", d.roundness);
    json.value("bounding_radius_m", shape->bounding_radius);
    json.value("lipschitz", shape->lipschitz);
    json.value("nodes", shape->nodes.size());
    json.begin_array("grid");
    for (const std::int32_t dim : shape->level_set.dims) json.value({}, dim);
    json.end();
    json.value("voxel_m", shape->level_set.spacing);
    json.value("memory_bytes", memory_of(*shape));
    json.end();
  }
  json.end();
  json.end();
  return json.text();
}

}  // namespace

void add_grains_info(CLI::App& grains) {
  struct Options {
    std::string library;
    std::vector<std::string> names;
    bool json{false};
  };
  CLI::App* command =
      grains.add_subcommand("info", "Check a shape library and print a table of its grains");
  command->footer("Example:\n  reckon grains info sand.h5 --shape grain_3 --json");
  auto options = std::make_shared<Options>();
  command->add_option("library", options->library, "Shape library (.h5) or legacy folder")
      ->required();
  command->add_option("--shape", options->names, "Only grains of these names");
  command->add_flag("--json", options->json, "Answer in JSON");
  command->callback([=] {
    const ShapeLibrary library = load_library(options->library);
    const auto shapes = choose_shapes(library, options->names);
    if (options->json) {
      std::fputs(as_json(options->library, shapes).c_str(), stdout);
    } else {
      print_table(shapes);
      print_summary(shapes);
    }
  });
}

}  // namespace reckon::app
