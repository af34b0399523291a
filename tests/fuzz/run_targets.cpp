// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <stdexcept>

#include "reckon/core/file.hpp"
#include "reckon/output/checkpoint.hpp"
#include "reckon/output/fields.hpp"
#include "reckon/output/grain_fields.hpp"
#include "reckon/output/history.hpp"
#include "reckon/results/saved_fields.hpp"
#include "reckon/text/number_table.hpp"
#include "scratch.hpp"
#include "sealed_damage.hpp"
#include "targets.hpp"

namespace reckon::fuzz {
namespace {

/// Three grains in a row; the first two touch, and so do the last and a wall.
Checkpoint small_checkpoint() {
  Checkpoint checkpoint;
  checkpoint.state.step = 40;
  for (std::uint32_t n = 0; n < 3; ++n) {
    GrainState grain;
    grain.id = GrainId{n};
    grain.shape = ShapeId{n % 2};
    grain.position = {0.5 * n, 1, 2};
    grain.velocity = {0, -0.1 * n, 0};
    checkpoint.state.grains.push_back(grain);
  }
  const NodeSpring spring{.node = 7, .shear_force = {1e-3, 0, 0}, .normal = {0, 0, 1}};
  checkpoint.state.pair_springs.push_back({GrainId{0}, GrainId{1}, {spring, spring}});
  checkpoint.state.wall_springs.push_back({GrainId{2}, WallId{0}, {spring}});
  checkpoint.time_step = 1e-6;
  checkpoint.scene = "title = \"three grains\"\n";
  checkpoint.shape_digests = {11, 12};
  return checkpoint;
}

}  // namespace

Target checkpoint_target() {
  const auto folder = std::make_shared<const ScratchFolder>();
  return {.name = "checkpoint",
          .valid_inputs =
              [folder] {
                const std::filesystem::path file = folder->path() / "valid.h5";
                write_checkpoint(file, small_checkpoint());
                return std::vector<std::string>{read_file(file)};
              },
          .read =
              [folder](const std::string& input) {
                (void)read_checkpoint(folder->write("checkpoint.h5", input));
              },
          .damage =
              [folder](std::string_view input, RandomStream& random) {
                return damaged_sealed_file(input, random, folder->path());
              },
          .cost = 10};
}

Target fields_target() {
  const auto folder = std::make_shared<const ScratchFolder>();
  return {.name = "fields",
          .valid_inputs =
              [folder] {
                const std::filesystem::path file = folder->path() / "valid.vtp";
                FieldsAtStep fields;
                fields.grains = small_checkpoint().state.grains;
                fields.contacts = {{.grain = GrainId{0}, .partner = 1, .to = {0.5, 0, 0}}};
                fields.wall_displacement = {{0, 0, 1}};
                write_grain_points(file, fields, std::vector<ShapeSummary>(2), 2650);
                return std::vector<std::string>{read_file(file)};
              },
          .read =
              [folder](const std::string& input) {
                std::filesystem::create_directories(folder->path() / "fields");
                (void)folder->write(RunFolder::field_name("grains", 7), input);
                (void)read_fields(RunFolder{folder->path()}, 7, grain_fields());
              },
          .cost = 3};
}

Target membrane_target() {
  const auto folder = std::make_shared<const ScratchFolder>();
  return {.name = "membrane",
          .valid_inputs =
              [folder] {
                const std::filesystem::path file = folder->path() / "valid.vtp";
                MembraneAtStep membrane;
                membrane.places = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
                membrane.displacements = membrane.velocities = membrane.contact_forces =
                    membrane.places;
                membrane.triangles = {.connectivity = {0, 1, 2, 0, 2, 3}, .offsets = {3, 6}};
                write_membrane(file, membrane, 0.5);
                return std::vector<std::string>{read_file(file)};
              },
          .read =
              [folder](const std::string& input) {
                std::filesystem::create_directories(folder->path() / "fields");
                FieldsAtStep fields;
                fields.grains = small_checkpoint().state.grains;
                write_grain_points(folder->path() / RunFolder::field_name("grains", 7), fields,
                                   std::vector<ShapeSummary>(2), 2650);
                (void)folder->write(RunFolder::field_name("membrane", 7), input);
                (void)read_fields(RunFolder{folder->path()}, 7);
              },
          .cost = 3};
}

Target history_target() {
  const auto folder = std::make_shared<const ScratchFolder>();
  return {
      .name = "history",
      .valid_inputs =
          [] {
            return std::vector<std::string>{"step,time_s,contacts\n0,0,0\n100,0.5,12\n200,1e0,7\n"};
          },
      .read =
          [folder](const std::string& input) {
            const HistoryTable table = read_history(folder->write("history.csv", input));
            for (const auto& row : table.rows) {
              if (row.size() != table.header.size()) throw std::logic_error("a ragged row");
            }
          },
      .cost = 2};
}

Target number_table_target() {
  return {.name = "number_table",
          .valid_inputs = [] { return std::vector<std::string>{"# x y z\n1, 2 -3e-4\n0 0 1\n\n"}; },
          .read =
              [](const std::string& input) {
                const std::vector<double> numbers = read_number_table_text(input, 3, "table.dat");
                if (numbers.size() % 3 != 0) throw std::logic_error("a ragged row");
                for (const double number : numbers) {
                  if (!std::isfinite(number)) throw std::logic_error("no finite number");
                }
              }};
}

}  // namespace reckon::fuzz
