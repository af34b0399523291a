// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/shape_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <numbers>
#include <set>
#include <utility>

#include "reckon/avatar/analytic.hpp"
#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/avatar/level_set_text.hpp"
#include "reckon/avatar/library_file.hpp"
#include "reckon/avatar/merge_corners.hpp"
#include "reckon/avatar/mesh_parts.hpp"
#include "reckon/avatar/mesh_reader.hpp"
#include "reckon/avatar/mesh_repair.hpp"
#include "reckon/avatar/mesh_validation.hpp"
#include "reckon/avatar/spherical_harmonics.hpp"
#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/write_failure.hpp"
#include "reckon/math/portable.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

using std::numbers::pi;

constexpr double edges_per_voxel = 2;
constexpr double edges_per_wavelength = 6;
constexpr std::uint32_t first_look = 24;  // geodesic frequency that suffices for a size

double diameter_of(const TriangleMesh& mesh) {
  return portable::cbrt(6 * solid_properties(mesh).volume / pi);
}

double edge_for(const ShapeResolution& resolution, double diameter) {
  return resolution.voxel_size.value_or(diameter / resolution.voxels_per_diameter) /
         edges_per_voxel;
}

/// The division of a star-shaped grain's geodesic sphere for a resolution, and for wavelengths down
/// to 2 pi R / degree.
std::uint32_t frequency_for(const ShapeResolution& resolution, double diameter,
                            std::uint32_t degree) {
  const double shortest_wave = pi * diameter / std::max(degree, 1U);
  const double edge =
      std::min(edge_for(resolution, diameter), shortest_wave / edges_per_wavelength);
  return geodesic_frequency(diameter / 2, edge);
}

}  // namespace

ShapeSource mesh_file_source(const std::filesystem::path& file, double unit_in_metres) {
  return {file.stem().string(),
          [file, unit_in_metres](const ShapeResolution&) {
            TriangleMesh mesh = read_mesh(file, unit_in_metres);
            require_closed_surface(mesh, file.string());
            return mesh;
          },
          0, SurfaceKind::polyhedron};
}

namespace {

/// A mesh in metres, treated; `notes` gets what was done.
TriangleMesh treated_mesh(const std::filesystem::path& file, double unit_in_metres,
                          const MeshTreatment& treatment, std::vector<std::string>& notes) {
  TriangleMesh mesh = read_mesh(file, unit_in_metres);
  if (treatment.repair) {
    notes = repair_mesh(mesh, file.string(), treatment.merge_distance).text();
  } else if (treatment.merge) {
    MergedCorners merged = merge_corners(mesh, treatment.merge_distance);
    mesh = std::move(merged.mesh);
    if (merged.merged > 0) notes.push_back(merged.text());
  }
  return mesh;
}

}  // namespace

MeshFileSources mesh_file_sources(const std::filesystem::path& file, double unit_in_metres,
                                  const MeshTreatment& treatment) {
  if (!treatment.merge && !treatment.repair && !treatment.split) {
    return {{mesh_file_source(file, unit_in_metres)}, {}};
  }
  const std::string name = file.stem().string();
  MeshFileSources made;
  try {
    TriangleMesh mesh = treated_mesh(file, unit_in_metres, treatment, made.notes);
    std::vector<SolidPart> parts;
    if (treatment.split) {
      parts = separate_solids(mesh, file.string());
    } else {
      require_closed_surface(mesh, file.string());
      parts.push_back({std::move(mesh), {}});
    }
    if (parts.size() > 1) made.notes.push_back(fmt::format("found {} parts", parts.size()));
    for (std::size_t p = 0; p < parts.size(); ++p) {
      made.sources.push_back({parts.size() == 1 ? name : fmt::format("{}_{}", name, p + 1),
                              [part = std::move(parts[p])](const ShapeResolution&) {
                                if (part.fault) throw Error{part.fault->text()};
                                return part.mesh;
                              },
                              0, SurfaceKind::polyhedron});
    }
  } catch (const Error& error) {
    made.sources = {
        {name, [error](const ShapeResolution&) -> TriangleMesh { throw Error{error.text()}; }}};
  }
  return made;
}

ShapeSource harmonics_file_source(const std::filesystem::path& file, double unit_in_metres,
                                  std::optional<std::uint32_t> degree) {
  return {file.stem().string(),
          [=](const ShapeResolution& resolution) {
            SphericalHarmonicGrain grain = read_spherical_harmonics(file, unit_in_metres);
            if (degree) grain = truncated(std::move(grain), *degree);
            const double diameter = diameter_of(surface_mesh(grain, first_look));
            return surface_mesh(grain, frequency_for(resolution, diameter, grain.degree));
          },
          0, SurfaceKind::curved};
}

ShapeSource level_set_file_source(const std::filesystem::path& file, double unit_in_metres) {
  return {file.stem().string(), [file, unit_in_metres](const ShapeResolution&) {
            const LevelSet grid =
                parse_level_set_text(read_file(file), file.string(), unit_in_metres);
            TriangleMesh mesh = extract_surface(grid);
            require_closed_surface(mesh, file.string());
            return mesh;
          }};
}

ShapeSource solid_source(std::string name, double extent,
                         std::function<TriangleMesh(double target_edge)> mesh, SurfaceKind kind) {
  return {std::move(name),
          [extent, mesh = std::move(mesh)](const ShapeResolution& resolution) {
            const double coarse_edge = extent / 20;
            const double diameter = diameter_of(mesh(coarse_edge));
            return mesh(std::min(coarse_edge, edge_for(resolution, diameter)));
          },
          0, kind};
}

ShapeSource sphere_source(std::string name, double radius) {
  ShapeSource source = solid_source(std::move(name), 2 * radius,
                                    [radius](double edge) { return sphere_mesh(radius, edge); });
  source.sphere_radius = radius;
  return source;
}

ShapeSource equal_sphere_source(std::string name, double volume) {
  const double radius = portable::cbrt(volume / (4.0 / 3 * std::numbers::pi));
  return sphere_source(std::move(name), radius);
}

ShapeSource generated_source(const GrainStatistics& statistics, std::uint64_t seed,
                             std::uint64_t index) {
  return {fmt::format("grain_{}", index + 1),
          [=](const ShapeResolution& resolution) {
            const std::uint32_t degree = statistics.highest_degree;
            const std::uint32_t look = std::max(first_look, degree);
            const double diameter = diameter_of(generate_grain(statistics, seed, index, look));
            return generate_grain(statistics, seed, index,
                                  std::max(frequency_for(resolution, diameter, degree), degree));
          },
          0, SurfaceKind::curved};
}

namespace {

void require_distinct_names(std::span<const ShapeSource> sources) {
  std::set<std::string_view> names;
  for (const ShapeSource& source : sources) {
    if (!names.insert(source.name).second) {
      throw Error{{.place = {},
                   .problem = "two grains are named " + source.name,
                   .reason = "scenes pick shapes by name",
                   .fix = "Rename one of the files."}};
    }
  }
}

struct Built {
  Shape shape;
  std::optional<Error> fault;
};

/// All shapes, or why not. `on_progress` as in build_library.
std::vector<Built> build_each(std::span<const ShapeSource> sources,
                              const ShapeResolution& resolution,
                              const std::function<void(std::size_t done)>& on_progress) {
  std::vector<Built> built(sources.size());
  std::mutex mutex;
  std::size_t done = 0;
  const auto build = [&](std::size_t s) {
    try {
      Shape shape =
          build_shape(sources[s].surface(resolution), resolution, sources[s].name, sources[s].kind);
      if (sources[s].sphere_radius > 0) {
        shape.sphere_radius = sources[s].sphere_radius;
        shape.bounding_radius = std::max(shape.bounding_radius, shape.sphere_radius);
      }
      built[s].shape = std::move(shape);
    } catch (const MachineFailure&) {
      throw;
    } catch (const Error& error) {
      built[s].fault = error;
    }
    const std::lock_guard lock{mutex};
    ++done;
    if (on_progress) on_progress(done);
  };
  // Loops inside a shape run on one thread while the loop over shapes has them all.
  if (sources.size() >= static_cast<std::size_t>(thread_count())) {
    parallel_for(sources.size(), 1, build);
  } else {
    for (std::size_t s = 0; s < sources.size(); ++s) build(s);
  }
  return built;
}

}  // namespace

ShapeLibrary build_library(std::span<const ShapeSource> sources, const ShapeResolution& resolution,
                           const std::function<void(std::size_t done)>& on_progress) {
  require_distinct_names(sources);
  ShapeLibrary library;
  library.reserve(sources.size());
  for (Built& built : build_each(sources, resolution, on_progress)) {
    if (built.fault) throw Error{built.fault->text()};
    library.push_back(std::move(built.shape));
  }
  return library;
}

std::vector<Error> build_library_file(const std::filesystem::path& path,
                                      std::span<const ShapeSource> sources,
                                      const ShapeResolution& resolution,
                                      const Provenance& provenance,
                                      const std::function<void(std::size_t done)>& on_progress) {
  require_distinct_names(sources);
  LibraryWriter writer{path, resolution.storage, provenance};
  std::vector<Error> faults;
  const std::size_t at_a_time = 32 * static_cast<std::size_t>(thread_count());
  for (std::size_t first = 0; first < sources.size(); first += at_a_time) {
    const auto some = sources.subspan(first, std::min(at_a_time, sources.size() - first));
    const auto progress = [&](std::size_t done) {
      if (on_progress) on_progress(first + done);
    };
    for (const Built& built : build_each(some, resolution, progress)) {
      if (built.fault) {
        faults.push_back(*built.fault);
      } else {
        writer.add(built.shape);
      }
    }
  }
  if (faults.size() < sources.size() || sources.empty()) writer.finish();
  return faults;
}

}  // namespace reckon
