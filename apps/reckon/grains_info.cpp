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
#include "reckon/core/utf8.hpp"
#include "reckon/text/human.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon::app {
namespace {

/// A shape and the sizes of its arrays, without the arrays.
struct Entry {
  Shape shape;
  ShapeSummary summary;
};
using Entries = std::vector<Entry>;

Entries checked_entries(const LibrarySource& library, std::span<const std::string> names) {
  Entries entries;
  for (const std::size_t s : choose_shapes(library, names)) {
    const Shape shape = library.read(s);
    entries.push_back({library.entry(s), summary_of(shape)});
  }
  return entries;
}

/// Metres in the unit that suits most grains of a library, so that a column can be compared.
struct LengthUnit {
  const char* name;
  double metres;
};
LengthUnit unit_for(const Entries& entries) {
  std::vector<double> diameters;
  diameters.reserve(entries.size());
  for (const Entry& entry : entries)
    diameters.push_back(entry.shape.descriptors.equivalent_diameter);
  const auto middle = diameters.begin() + static_cast<std::ptrdiff_t>(diameters.size() / 2);
  std::nth_element(diameters.begin(), middle, diameters.end());
  if (*middle < 1e-4) return {"um", 1e-6};
  if (*middle < 1) return {"mm", 1e-3};
  return {"m", 1};
}

void print_table(const Entries& entries) {
  const LengthUnit unit = unit_for(entries);
  std::size_t width = 5;
  for (const Entry& entry : entries) width = std::max(width, printable(entry.shape.name).size());
  fmt::print(
      "{:<{}} {:>10} {:>8} {:>8} {:>8} {:>8} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>13} {:>9}\n",
      "name", width, fmt::format("vol {}^3", unit.name), fmt::format("d {}", unit.name),
      fmt::format("L {}", unit.name), fmt::format("W {}", unit.name),
      fmt::format("T {}", unit.name), "W/L", "T/W", "spher.", "convex", "round.", "nodes", "grid",
      "memory");
  const double m = unit.metres;
  for (const auto& [shape, summary] : entries) {
    const ShapeDescriptors& d = shape.descriptors;
    const auto& dims = shape.level_set.dims;
    fmt::print(
        "{:<{}} {:>10.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>8.4g} {:>6.3f} {:>6.3f} {:>6.3f} {:>6.3f} "
        "{:>6.3f} {:>6} {:>13} {:>9}\n",
        printable(shape.name), width, shape.mass.volume / (m * m * m), d.equivalent_diameter / m,
        d.length / m, d.width / m, d.thickness / m, d.elongation, d.flatness, d.sphericity,
        d.convexity, d.roundness, summary.outline.nodes,
        fmt::format("{}x{}x{}", dims[0], dims[1], dims[2]), human_bytes(summary.outline.memory()));
  }
}

void print_summary(const Entries& entries) {
  const LengthUnit unit = unit_for(entries);
  std::uint64_t memory = 0;
  std::uint64_t nodes = 0;
  for (const auto& [shape, summary] : entries) {
    memory += summary.outline.memory();
    nodes += summary.outline.nodes;
  }
  const auto range = [&](const char* what, double scale,
                         const std::function<double(const ShapeDescriptors&)>& value) {
    double low = value(entries.front().shape.descriptors);
    double high = low;
    double mean = 0;
    for (const auto& [shape, summary] : entries) {
      const double v = value(shape.descriptors);
      low = std::min(low, v);
      high = std::max(high, v);
      mean += v / static_cast<double>(entries.size());
    }
    fmt::print("  {:<24} {:>9.4g} {:>9.4g} {:>9.4g}\n", what, low / scale, mean / scale,
               high / scale);
  };
  fmt::print("\n{}, {} nodes, {} in memory, checksums good\n", counted(entries.size(), "grain"),
             human_count(nodes), human_bytes(memory));
  if (entries.size() == 1) return;
  fmt::print("  {:<24} {:>9} {:>9} {:>9}\n", "", "min", "mean", "max");
  range(fmt::format("diameter {}", unit.name).c_str(), unit.metres,
        [](const auto& d) { return d.equivalent_diameter; });
  range("elongation W/L", 1, [](const auto& d) { return d.elongation; });
  range("flatness T/W", 1, [](const auto& d) { return d.flatness; });
  range("sphericity", 1, [](const auto& d) { return d.sphericity; });
  range("convexity", 1, [](const auto& d) { return d.convexity; });
  range("roundness", 1, [](const auto& d) { return d.roundness; });
}

/// The words of a command as a shell takes them.
std::string shell_text(const std::vector<std::string>& words) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./,:=+@%";
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) text += c == '\'' ? std::string{"'\\''"} : std::string{c};
    text += '\'';
  }
  return text;
}

void print_provenance(const Provenance& made) {
  if (made.program.empty()) return;
  fmt::print("\nmade by    {}\n", made.program);
  if (!made.command.empty()) fmt::print("command    {}\n", shell_text(made.command));
  constexpr std::size_t most_lines = 10;
  for (std::size_t s = 0; s < std::min(most_lines, made.sources.size()); ++s) {
    const SourceFile& file = made.sources[s];
    fmt::print("source     {}, {} bytes, xxh64 {:016x}\n", file.path, file.bytes, file.xxh64);
  }
  if (made.sources.size() > most_lines) {
    fmt::print("           and {} more files (--json lists all)\n",
               made.sources.size() - most_lines);
  }
}

void add_provenance(JsonWriter& json, const Provenance& made) {
  if (made.program.empty()) return;
  json.begin_object("made");
  json.value("program", made.program);
  json.begin_array("command");
  for (const std::string& word : made.command) json.value({}, word);
  json.end();
  json.begin_array("sources");
  for (const SourceFile& file : made.sources) {
    json.begin_object();
    json.value("file", file.path);
    json.value("bytes", file.bytes);
    json.value("xxh64", fmt::format("{:016x}", file.xxh64));
    json.end();
  }
  json.end();
  json.end();
}

std::string as_json(const std::string& file, const Entries& entries, const Provenance& made) {
  JsonWriter json;
  json.begin_object();
  json.value("file", file);
  json.value("checksums_good", true);
  add_provenance(json, made);
  json.begin_array("grains");
  for (const auto& [shape, summary] : entries) {
    const ShapeDescriptors& d = shape.descriptors;
    json.begin_object();
    json.value("name", shape.name);
    json.value("digest", fmt::format("{:016x}", summary.digest));
    json.value("volume_m3", shape.mass.volume);
    json.begin_array("principal_inertia_over_density_m5");
    for (int axis = 0; axis < 3; ++axis) json.value({}, shape.mass.inertia[axis]);
    json.end();
    json.value("surface_area_m2", d.surface_area);
    json.value("equivalent_diameter_m", d.equivalent_diameter);
    json.value("sieve_size_m", d.sieve_size);
    json.value("length_m", d.length);
    json.value("width_m", d.width);
    json.value("thickness_m", d.thickness);
    json.value("elongation", d.elongation);
    json.value("flatness", d.flatness);
    json.value("sphericity", d.sphericity);
    json.value("convexity", d.convexity);
    json.value("roundness", d.roundness);
    json.value("bounding_radius_m", shape.bounding_radius);
    json.value("lipschitz", shape.lipschitz);
    json.value("nodes", summary.outline.nodes);
    json.begin_array("grid");
    for (const std::int32_t dim : shape.level_set.dims) json.value({}, dim);
    json.end();
    json.value("voxel_m", shape.level_set.spacing);
    json.value("memory_bytes", summary.outline.memory());
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
  command->add_option("--shape", options->names, "Only grains with these names");
  command->add_flag("--json", options->json, "Answer in JSON");
  command->callback([=] {
    const LibrarySource library{options->library};
    const Entries entries = checked_entries(library, options->names);
    if (options->json) {
      std::fputs(as_json(options->library, entries, library.provenance()).c_str(), stdout);
    } else {
      print_table(entries);
      print_summary(entries);
      print_provenance(library.provenance());
    }
  });
}

}  // namespace reckon::app
