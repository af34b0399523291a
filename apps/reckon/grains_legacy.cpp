// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "grains_parts.hpp"
#include "reckon/avatar/legacy_morphology.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/text/human.hpp"

namespace reckon::app {

void add_grains_legacy(CLI::App& grains, const CommandWords& words) {
  struct Options {
    std::string input;
    std::string output;
    std::string voxel{"1m"};
    bool keep_radius{false};
  };
  {
    CLI::App* command = grains.add_subcommand(
        "from-legacy", "Make grains from a folder of LS-DEM morphology files, morph_1.dat, ...");
    command->footer("Example:\n  reckon grains from-legacy Morphologies --voxel 13um -o sand.h5");
    auto options = std::make_shared<Options>();
    command->add_option("folder", options->input, "Folder with the files")
        ->required()
        ->check(CLI::ExistingDirectory);
    command->add_option("-o,--output", options->output, "Shape library to write (.h5)")->required();
    command->add_option("--voxel", options->voxel, "Edge of a voxel of the scan, e.g. 13um")
        ->capture_default_str();
    command->add_flag("--keep-radius", options->keep_radius,
                      "Keep the files' bounding radii even where the grain reaches beyond");
    command->callback([=] {
      const ShapeLibrary library = load_legacy_folder(
          options->input, parse_length("--voxel", options->voxel),
          options->keep_radius ? LegacyRadius::as_in_file : LegacyRadius::enclosing);
      save_library(options->output, library, provenance_of(words, {options->input}));
      fmt::print("{}: {}\n", options->output, counted(library.size(), "grain"));
    });
  }
  CLI::App* command = grains.add_subcommand(
      "to-legacy", "Write a shape library as LS-DEM morphology files, one voxel per grid spacing");
  command->footer("Example:\n  reckon grains to-legacy sand.h5 Morphologies");
  auto options = std::make_shared<Options>();
  command->add_option("library", options->input, "Shape library (.h5)")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_option("folder", options->output, "Folder to write morph_1.dat, ... into")
      ->required();
  command->callback([=] {
    const ShapeLibrary library = load_library(options->input);
    save_legacy_folder(options->output, library);
    fmt::print("{}: {}\n", options->output, counted(library.size(), "file"));
  });
}

}  // namespace reckon::app
