// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <stdexcept>

#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/legacy_morphology.hpp"
#include "reckon/avatar/level_set_text.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/shape_builder.hpp"
#include "reckon/core/file.hpp"
#include "scratch.hpp"
#include "sealed_damage.hpp"
#include "targets.hpp"

namespace reckon::fuzz {
namespace {

Shape small_ball(const std::string& name) {
  return build_shape(geodesic_sphere(2), {.voxels_per_diameter = 10, .node_count = 12}, name);
}

std::string small_morphology() { return format_legacy_morphology(to_legacy(small_ball("ball"))); }

}  // namespace

Target shape_library_target() {
  const auto folder = std::make_shared<const ScratchFolder>();
  return {.name = "shape_library",
          .valid_inputs =
              [folder] {
                const std::filesystem::path file = folder->path() / "valid.h5";
                save_library(file, {small_ball("one"), small_ball("two")},
                             {{}, {"reckon", "grains"}, {{"ball.stl", 84, 7}}});
                std::vector<std::string> files{read_file(file)};
                Shape band = small_ball("band");
                round_to_band(band);
                save_library(file, {band});
                files.push_back(read_file(file));
                return files;
              },
          .read =
              [folder](const std::string& input) {
                const ShapeLibrary library = load_library(folder->write("library.h5", input));
                for (const Shape& shape : library) check_shape(shape, shape.name);
              },
          .damage =
              [folder](std::string_view input, RandomStream& random) {
                return damaged_sealed_file(input, random, folder->path());
              },
          .cost = 10};
}

Target legacy_morphology_target() {
  return {.name = "legacy_morphology",
          .valid_inputs = [] { return std::vector<std::string>{small_morphology()}; },
          .read =
              [](const std::string& input) {
                const LegacyMorphology grain = parse_legacy_morphology(input, "morph_1.dat");
                if (format_legacy_morphology(grain).empty()) throw std::logic_error("lost");
              },
          .cost = 4};
}

Target legacy_shape_target() {
  return {.name = "legacy_shape",
          .valid_inputs = [] { return std::vector<std::string>{small_morphology()}; },
          .read =
              [](const std::string& input) {
                const LegacyMorphology grain = parse_legacy_morphology(input, "morph_1.dat");
                check_shape(to_shape(grain, 1e-5, "morph_1", LegacyRadius::enclosing), "morph_1");
              },
          .cost = 80};
}

Target legacy_positions_target() {
  return {
      .name = "legacy_positions",
      .valid_inputs = [] { return std::vector<std::string>{"1.5 2 3e1\n-1 0 0.25\n"}; },
      .read = [](const std::string& input) { (void)parse_legacy_positions(input, "positions"); }};
}

Target legacy_rotations_target() {
  return {
      .name = "legacy_rotations",
      .valid_inputs = [] { return std::vector<std::string>{"0 0 0 1\n0.6 0 -0.8 0\n"}; },
      .read = [](const std::string& input) { (void)parse_legacy_rotations(input, "rotations"); }};
}

Target level_set_text_target() {
  return {
      .name = "level_set_text",
      .valid_inputs =
          [] {
            return std::vector<std::string>{
                "a cube's corner\n2 2 3\n0.5\n-0.5 -0.5 -1\n"
                "-0.1\n0.2\n0.3\n0.4\n0.1\n0.2\n0.3\n0.4\n0.1\n0.2\n0.3\n0.4\n"};
          },
      .read = [](const std::string& input) { (void)parse_level_set_text(input, "grid", 1e-3); }};
}

}  // namespace reckon::fuzz
