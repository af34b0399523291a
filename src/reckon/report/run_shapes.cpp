// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/run_shapes.hpp"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <span>

#include "reckon/avatar/shape_catalog.hpp"
#include "reckon/avatar/shape_statistics.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/io/run_surfaces.hpp"
#include "reckon/io/saved_fields.hpp"
#include "reckon/io/scene_reader.hpp"

namespace reckon {
namespace {

// A graphics card draws some millions of triangles in a frame; a page of tens of megabytes still
// opens at once.
constexpr std::size_t triangles_on_screen = 1'500'000;
constexpr std::size_t triangles_in_page = 1'200'000;
constexpr std::size_t most_triangles = 2400;
constexpr std::size_t fewest_triangles = 160;
constexpr std::size_t coarse_triangles = 48;

std::size_t triangles_per_grain(std::span<const std::uint64_t> grains) {
  const std::uint64_t total = std::accumulate(grains.begin(), grains.end(), std::uint64_t{0});
  const auto used = static_cast<std::size_t>(
      std::count_if(grains.begin(), grains.end(), [](std::uint64_t count) { return count > 0; }));
  const std::size_t wanted = std::min(triangles_on_screen / std::max<std::size_t>(total, 1),
                                      triangles_in_page / std::max<std::size_t>(used, 1));
  return std::clamp(wanted, fewest_triangles, most_triangles);
}

ShapeCatalog catalog_of(const RunFolder& folder, const SceneConfig& scene) {
  const std::vector<std::uint64_t> checkpoints = folder.checkpoint_steps();
  if (!checkpoints.empty()) {
    return shapes_of(read_checkpoint(folder.checkpoint(checkpoints.front())),
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

SceneConfig scene_of_run(const RunFolder& folder) {
  if (!std::filesystem::exists(folder.resolved())) {
    throw Error{{.place = folder.root().string(),
                 .problem = "this is not the folder of a run",
                 .reason = "it has no scene_resolved.toml",
                 .fix = "Name a folder that `reckon run` has written."}};
  }
  // Faults of files that have gone since do not matter here.
  return read_scene_text(read_file(folder.resolved()), folder.root()).config;
}

std::vector<std::uint64_t> grains_by_shape(const RunFolder& folder, std::uint64_t step) {
  std::vector<std::uint64_t> counts;
  for (const SavedGrain& grain : read_fields(folder, step).grains) {
    counts.resize(std::max<std::size_t>(counts.size(), grain.shape.get() + std::size_t{1}));
    ++counts[grain.shape.get()];
  }
  return counts;
}

RunShapes read_run_shapes(const RunFolder& folder, const SceneConfig& scene,
                          const std::vector<std::uint64_t>& grains) {
  RunShapes result{.grains = grains};
  const std::size_t triangles = triangles_per_grain(grains);
  try {
    const ShapeCatalog catalog = catalog_of(folder, scene);
    if (catalog.size() < grains.size()) {
      return {.grains = grains,
              .missing = "a shape library named in scene_resolved.toml has changed"};
    }
    for (std::uint32_t s = 0; s < catalog.size(); ++s) {
      const bool used = s < grains.size() && grains[s] > 0;
      result.shapes.push_back(make_shape(catalog.read(ShapeId{s}), used, triangles));
    }
  } catch (const Error& error) {
    return {.grains = grains, .missing = error.what()};
  }
  return result;
}

}  // namespace reckon
