// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "grains_parts.hpp"
#include "progress.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/mesh_parts.hpp"
#include "reckon/avatar/mesh_validation.hpp"
#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/avatar/surface_files.hpp"
#include "reckon/core/error.hpp"
#include "reckon/text/human.hpp"

namespace reckon::app {
namespace {

/// A shape's name as a file name: it may hold anything, slashes included.
std::string file_name(const std::string& name) {
  std::string safe = name;
  std::replace_if(
      safe.begin(), safe.end(), [](char c) { return c == '/' || c == '\0'; }, '_');
  return safe == "." || safe == ".." ? "_" : safe;
}

/// Writes the grain's surface as the mesh of one solid. Its grid may hold more: a void or a crumb
/// where a crevice is too narrow for the voxels. What is left out is printed, and whatever would
/// make `from-mesh` refuse the file.
void export_stl(const std::filesystem::path& file, const Shape& shape) {
  const LargestPart part = largest_part(extract_surface(shape.level_set));
  write_stl(file, part.mesh, shape.name);
  if (part.others > 0) {
    fmt::print(
        "{}: left out {} with {:.2g} % of the grain's volume\n", file.string(),
        part.others == 1 ? "a void or crumb" : fmt::format("{} voids or crumbs", part.others),
        100 * part.others_volume);
  }
  try {
    require_closed_surface(rounded_to_stl(part.mesh), file.string());
  } catch (const Error& error) {
    fmt::print(stderr, "reckon: warning: {}\n", error.what());
  }
}

}  // namespace

void add_grains_export(CLI::App& grains) {
  struct Options {
    std::string library;
    std::string format{"vtp"};
    std::string folder;
    std::vector<std::string> names;
  };
  CLI::App* command = grains.add_subcommand(
      "export", "Write the surfaces that contacts use, for ParaView or as meshes");
  command->footer("Example:\n  reckon grains export sand.h5 --format stl --out look");
  auto options = std::make_shared<Options>();
  command->add_option("library", options->library, "Shape library (.h5) or legacy folder")
      ->required();
  command->add_option("--format", options->format, "vtp: also NAME_nodes.vtp; stl: in metres")
      ->capture_default_str()
      ->check(CLI::IsMember({"vtp", "stl"}));
  command->add_option("--out", options->folder, "Output folder; created if missing")->required();
  command->add_option("--shape", options->names, "Only grains with these names");
  command->callback([=] {
    const LibrarySource library{options->library};
    const auto shapes = choose_shapes(library, options->names);
    const std::filesystem::path folder{options->folder};
    std::filesystem::create_directories(folder);
    CountDisplay display{"grains"};
    std::size_t done = 0;
    for (const std::size_t s : shapes) {
      const Shape shape = library.read(s);
      const std::string name = file_name(shape.name);
      if (options->format == "stl") {
        export_stl(folder / (name + ".stl"), shape);
      } else {
        write_surface_vtp(folder / (name + ".vtp"), shape);
        write_nodes_vtp(folder / (name + "_nodes.vtp"), shape);
      }
      display.show(++done, shapes.size());
    }
    fmt::print("{}: {}\n", options->folder, counted(shapes.size(), "grain"));
  });
}

}  // namespace reckon::app
