// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "reckon/avatar/descriptors.hpp"
#include "reckon/avatar/inside_radius.hpp"
#include "reckon/avatar/legacy_morphology.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/avatar/surface_nodes.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/shape/node_order.hpp"

namespace reckon {
namespace {

constexpr std::size_t area_samples_per_node = 256;

/// The grid with one more layer outside all around, positive there: a grain that fills its grid to
/// the edge is closed there.
LevelSet padded(const LevelSet& grid) {
  LevelSet wider;
  wider.dims = {grid.dims[0] + 2, grid.dims[1] + 2, grid.dims[2] + 2};
  wider.spacing = grid.spacing;
  wider.origin_body = grid.origin_body - grid.spacing * Vec3{1, 1, 1};
  wider.values.assign(static_cast<std::size_t>(wider.dims[0]) *
                          static_cast<std::size_t>(wider.dims[1]) *
                          static_cast<std::size_t>(wider.dims[2]),
                      static_cast<float>(grid.spacing));
  for (std::int32_t k = 0; k < grid.dims[2]; ++k) {
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      for (std::int32_t i = 0; i < grid.dims[0]; ++i) {
        wider.values[wider.index(i + 1, j + 1, k + 1)] = grid.values[grid.index(i, j, k)];
      }
    }
  }
  return wider;
}

OrientedPoints with_normals(const LevelSetView& grid, const SurfaceNodes& nodes) {
  OrientedPoints points;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const Vec3 position = nodes.position(n);
    const auto sample = grid.sample(position);
    points.position.push_back(position);
    points.normal.push_back(normalized(sample.inside_grid ? sample.gradient_body : position));
  }
  return points;
}

/// NUMBER of a file name morph_NUMBER.dat.
std::optional<std::uint32_t> morphology_number(const std::string& file_name) {
  constexpr std::string_view prefix = "morph_";
  constexpr std::string_view suffix = ".dat";
  if (!file_name.starts_with(prefix) || !file_name.ends_with(suffix)) return std::nullopt;
  const char* const begin = file_name.data() + prefix.size();
  const char* const end = file_name.data() + file_name.size() - suffix.size();
  std::uint32_t number = 0;
  const auto result = std::from_chars(begin, end, number);
  if (begin >= end || result.ec != std::errc{} || result.ptr != end) return std::nullopt;
  return number;
}

}  // namespace

Shape to_shape(const LegacyMorphology& m, double voxel, const std::string& name,
               LegacyRadius radius) {
  // Distances are kept in single precision, and moments grow with the fifth power.
  constexpr double smallest = 1e-30;
  constexpr double largest = 1e30;
  if (!(voxel >= smallest && voxel <= largest)) {
    throw Error{{.place = name,
                 .problem = "the voxel's length must be between 1e-30 and 1e30 m",
                 .reason = fmt::format("{} m was given", voxel),
                 .fix = "Give the scan's voxel length."}};
  }
  const double voxel3 = voxel * voxel * voxel;
  Shape shape;
  shape.name = name;
  shape.mass = {m.mass * voxel3, voxel3 * voxel * voxel * m.moments};
  shape.level_set.dims = m.dims;
  shape.level_set.spacing = voxel;
  shape.level_set.origin_body = voxel * -m.center_of_mass;
  shape.level_set.values = m.values;
  for (float& value : shape.level_set.values) value = static_cast<float>(voxel * value);
  SurfaceNodes nodes;
  for (const Vec3& node : m.nodes) {
    nodes.x.push_back(voxel * node.x);
    nodes.y.push_back(voxel * node.y);
    nodes.z.push_back(voxel * node.z);
  }
  nodes.area.assign(nodes.x.size(), 0.0);
  shape.nodes = in_compact_order(nodes);

  const TriangleMesh surface = extract_surface(padded(shape.level_set));
  if (surface.triangles.empty()) {
    throw Error{{.place = name,
                 .problem = "the grid holds no grain",
                 .reason = "no value is negative",
                 .fix = "Check the sign: the inside is negative."}};
  }
  SolidProperties solid = solid_properties(surface);
  const OrientedPoints samples =
      sample_surface(surface, area_samples_per_node * shape.nodes.size());
  shape.nodes.area =
      tributary_areas(with_normals(shape.level_set, shape.nodes), samples, solid.surface_area);
  shape.clusters = make_clusters(shape.nodes);
  shape.lipschitz = lipschitz_constant(shape.level_set);
  shape.bounding_radius = voxel * m.bounding_radius;
  if (radius == LegacyRadius::enclosing) {
    double reach = shape.bounding_radius;
    for (const Vec3& node : m.nodes) reach = std::max(reach, norm(voxel * node));
    shape.bounding_radius = inside_radius(shape.level_set, reach);
  }
  solid.volume = shape.mass.volume;
  shape.descriptors = describe_shape(surface, TriangleBvh{surface}, solid, shape.level_set);
  check_shape(shape, name);
  return shape;
}

LegacyMorphology to_legacy(const Shape& shape) {
  const double voxel = shape.level_set.spacing;
  const double voxel3 = voxel * voxel * voxel;
  LegacyMorphology m;
  m.mass = shape.mass.volume / voxel3;
  m.moments = shape.mass.inertia / (voxel3 * voxel * voxel);
  m.center_of_mass = -shape.level_set.origin_body / voxel;
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    m.nodes.push_back(shape.nodes.position(n) / voxel);
  }
  m.bounding_radius = shape.bounding_radius / voxel;
  m.dims = shape.level_set.dims;
  for (const float value : shape.level_set.values) {
    m.values.push_back(static_cast<float>(value / voxel));
  }
  return m;
}

ShapeLibrary load_legacy_folder(const std::filesystem::path& folder, double voxel,
                                LegacyRadius radius) {
  std::vector<std::pair<std::uint32_t, std::filesystem::path>> files;
  for (const auto& entry : std::filesystem::directory_iterator{folder}) {
    if (const auto number = morphology_number(entry.path().filename().string())) {
      files.emplace_back(*number, entry.path());
    }
  }
  if (files.empty()) {
    throw Error{{.place = folder.string(),
                 .problem = "holds no morphology files",
                 .reason = "they are named morph_1.dat, morph_2.dat, ...",
                 .fix = "Give the folder that has them."}};
  }
  std::sort(files.begin(), files.end());
  ShapeLibrary library(files.size());
  parallel_for(files.size(), 1, [&](std::size_t f) {
    const auto& path = files[f].second;
    library[f] = to_shape(parse_legacy_morphology(read_file(path), path.string()), voxel,
                          path.stem().string(), radius);
  });
  return library;
}

void save_legacy_folder(const std::filesystem::path& folder, const ShapeLibrary& library) {
  std::filesystem::create_directories(folder);
  for (std::size_t s = 0; s < library.size(); ++s) {
    write_file(folder / fmt::format("morph_{}.dat", s + 1),
               format_legacy_morphology(to_legacy(library[s])));
  }
}

}  // namespace reckon
