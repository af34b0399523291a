// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/run_shapes.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "reckon/avatar/shape_catalog.hpp"
#include "reckon/avatar/shape_statistics.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/results/run_surfaces.hpp"
#include "reckon/results/saved_fields.hpp"
#include "reckon/scene/scene_reader.hpp"

namespace reckon {
namespace {

// A graphics card draws some millions of triangles in a frame; a page of tens of megabytes still
// opens at once.
constexpr std::size_t triangles_on_screen = 1'500'000;
constexpr std::size_t triangles_in_page = 1'200'000;
constexpr std::size_t most_triangles = 2400;
constexpr std::size_t fewest_triangles = 160;
constexpr std::size_t coarse_triangles = 48;

std::size_t triangles_per_grain(const GrainsByShape& grains) {
  std::uint64_t total = 0;
  for (const auto& [shape, count] : grains) total += count;
  const std::size_t wanted = std::min(triangles_on_screen / std::max<std::size_t>(total, 1),
                                      triangles_in_page / std::max<std::size_t>(grains.size(), 1));
  return std::clamp(wanted, fewest_triangles, most_triangles);
}

ShapeCatalog catalog_of(const RunFolder& folder, const SceneConfig& scene) {
  const std::vector<std::uint64_t> checkpoints = folder.checkpoint_steps();
  if (!checkpoints.empty()) {
    return shapes_of(read_checkpoint(folder.own(folder.checkpoint(checkpoints.front()))),
                     folder.root().string());
  }
  ShapeCatalog catalog;  // of a run that has none yet
  for (const GrainsConfig& set : scene.grains) catalog.add(set.library, set.voxel);
  return catalog;
}

RunShape make_shape(const Shape& shape, bool with_surface, std::size_t triangles) {
  RunShape made{.name = shape.name, .volume = shape.mass.volume};
  for (const ShapeMeasure& measure : shape_measures()) made.measures.push_back(measure.of(shape));
  if (!with_surface) return made;
  made.fine = display_mesh(shape.level_set, triangles);
  made.coarse = display_mesh(shape.level_set, coarse_triangles);
  return made;
}

}  // namespace

GrainsByShape grains_by_shape(const RunFolder& folder) {
  GrainsByShape counts;
  for (const std::uint64_t step : folder.field_steps("grains")) {
    try {
      for (const SavedGrain& grain : read_fields(folder, step).grains) ++counts[grain.shape.get()];
      break;
    } catch (const Error&) {
      counts.clear();  // damaged: reported where this step is shown; the next step suffices here
    }
  }
  return counts;
}

RunShapes read_run_shapes(const RunFolder& folder, const SceneConfig& scene,
                          const GrainsByShape& grains) {
  RunShapes result{.grains = grains};
  const std::size_t triangles = triangles_per_grain(grains);
  try {
    const ShapeCatalog catalog = catalog_of(folder, scene);
    const bool fits = grains.empty() || grains.rbegin()->first < catalog.size();
    if (!fits && folder.checkpoint_steps().empty()) {  // a checkpoint would have detected it
      return {.grains = grains,
              .missing = "a shape library named in scene_resolved.toml has changed"};
    }
    for (std::uint32_t s = 0; s < catalog.size(); ++s) {
      const bool used = grains.contains(s);
      result.shapes.push_back(make_shape(catalog.read(ShapeId{s}), used, triangles));
    }
  } catch (const Error& error) {
    return {.grains = grains, .missing = error.what()};
  }
  return result;
}

}  // namespace reckon
