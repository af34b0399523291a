// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/results/run_surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "reckon/core/error.hpp"
#include "reckon/core/vtk_xml.hpp"
#include "reckon/output/fields.hpp"
#include "reckon/results/saved_fields.hpp"
#include "reckon/scene/scene_reader.hpp"
#include "reckon/simulation/setup.hpp"
#include "reckon/text/free_memory.hpp"
#include "reckon/text/human.hpp"

namespace reckon {

ShapeCatalog shapes_of(const Checkpoint& checkpoint, const std::string& place) {
  const SceneReading reading = read_scene_text(checkpoint.scene, "/");
  ShapeCatalog catalog;
  for (const GrainsConfig& set : reading.config.grains) {
    if (!set.library.empty()) catalog.add(set.library, set.voxel);  // missing ones: see below
  }
  std::vector<std::uint64_t> digests;
  for (std::size_t s = 0; s < catalog.size(); ++s) {
    digests.push_back(catalog.summary(ShapeId{static_cast<std::uint32_t>(s)}).digest);
  }
  if (digests != checkpoint.shape_digests) {
    throw Error{{.place = place,
                 .problem = "the shapes of this run cannot be found",
                 .reason = "a shape library named in scene_resolved.toml is gone or has changed",
                 .fix = "Put it back."}};
  }
  return catalog;
}

FieldsAtStep fields_of(Checkpoint checkpoint) {
  FieldsAtStep fields{.step = checkpoint.state.step,
                      .time = static_cast<double>(checkpoint.state.step) * checkpoint.time_step};
  fields.grains = std::move(checkpoint.state.grains);
  if (const auto& cell = checkpoint.state.cell) {
    const CellConfig config = read_scene_text(checkpoint.scene, "/").config.cell.value();
    put_into(
        {0.5 * (config.box.low + config.box.high), periodic_axes(config), cell->edges, cell->rates},
        fields);
  }
  return fields;
}

SurfaceFiles write_run_surfaces(
    const RunFolder& folder, std::optional<std::uint64_t> step,
    const std::function<void(const std::string& size)>& announce,
    const std::function<void(std::size_t done, std::size_t total)>& progressed) {
  const std::string place = folder.root().string();
  std::vector<std::uint64_t> steps = folder.checkpoint_steps();
  if (steps.empty()) {
    throw Error{{.place = place,
                 .problem = "there is no checkpoint here",
                 .reason = {},
                 .fix = "Name the folder of a run."}};
  }
  if (step) {
    if (std::find(steps.begin(), steps.end(), *step) == steps.end()) {
      throw Error{{.place = place,
                   .problem = fmt::format("there is no checkpoint of step {}", *step),
                   .reason = {},
                   .fix = "Its folder checkpoints lists them."}};
    }
    steps = {*step};
  }
  std::vector<TriangleMesh> surfaces;
  std::vector<ShapeSummary> summaries;
  double time_step = 0;
  std::size_t done = 0;
  double density = 0;
  for (const std::uint64_t at : steps) {
    Checkpoint checkpoint = read_checkpoint(folder.own(folder.checkpoint(at)));
    if (surfaces.empty()) {
      const ShapeCatalog shapes = shapes_of(checkpoint, place);
      surfaces = surface_meshes(checkpoint.state.grains,
                                [&](ShapeId shape) { return shapes.read(shape); });
      for (std::size_t s = 0; s < shapes.size(); ++s) {
        summaries.push_back(shapes.summary(ShapeId{static_cast<std::uint32_t>(s)}));
      }
      density = read_scene_text(checkpoint.scene, "/").config.material.density;
      const SurfaceSize size = size_of_surfaces(checkpoint.state.grains, surfaces);
      require_memory(
          size.bytes, fmt::format("a file of {} triangles", human_count(size.triangles)),
          "Look at fewer grains, or at grains as points with their shapes (grains.pvd).");
      if (announce) {
        announce(fmt::format("{} of {} triangles: {} of disk each, as much memory",
                             counted(steps.size(), "file"), human_count(size.triangles),
                             human_bytes(size.bytes)));
      }
    }
    time_step = checkpoint.time_step;
    FieldsAtStep fields = fields_of(std::move(checkpoint));
    fields.has_contacts =
        std::filesystem::exists(folder.root() / RunFolder::field_name("contacts", at));
    if (fields.has_contacts) fields.contacts = read_fields(folder, at).contacts;
    write_grain_surfaces(folder.root() / RunFolder::field_name("surfaces", at), fields, summaries,
                         density, surfaces);
    if (progressed) progressed(++done, steps.size());
  }
  std::vector<PvdEntry> entries;
  for (const std::uint64_t at : folder.field_steps("surfaces")) {
    entries.push_back(
        {static_cast<double>(at) * time_step, RunFolder::field_name("surfaces", at), {}});
  }
  write_pvd(folder.index("surfaces"), entries);
  return {steps.size(), folder.index("surfaces")};
}

}  // namespace reckon
