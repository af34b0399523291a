// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/shape_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "reckon/avatar/creases.hpp"
#include "reckon/avatar/curved_surface.hpp"
#include "reckon/avatar/descriptors.hpp"
#include "reckon/avatar/distance_transform.hpp"
#include "reckon/avatar/grid_mass.hpp"
#include "reckon/avatar/inside_radius.hpp"
#include "reckon/avatar/interpolation_bias.hpp"
#include "reckon/avatar/surface_nodes.hpp"
#include "reckon/core/error.hpp"
#include "reckon/math/portable.hpp"
#include "reckon/parallel/threads.hpp"
#include "reckon/shape/node_order.hpp"

namespace reckon {
namespace {

// Shares of samples give the area of a node within about 2 %, with half as many within 3 %.
constexpr std::size_t area_samples_per_node = 256;
constexpr std::size_t many_nodes = 2000;     // need less accuracy
constexpr double largest_lost_share = 0.05;  // of the nodes

[[noreturn]] void refuse(const std::string& name, std::string problem, std::string reason,
                         std::string fix) {
  throw Error{{.place = name,
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = std::move(fix)}};
}

void check_resolution(const ShapeResolution& resolution, double diameter, const std::string& name) {
  const double voxels =
      resolution.voxel_size ? diameter / *resolution.voxel_size : resolution.voxels_per_diameter;
  if (!(voxels >= 10)) {
    refuse(name, "the grid would be too coarse",
           fmt::format("{:.3g} voxels per diameter, and at least 10 are needed", voxels),
           "Give more voxels per diameter or a smaller voxel.");
  }
  const bool spacing_good = resolution.node_spacing > 0 && resolution.node_spacing <= 0.5;
  if (resolution.node_count ? *resolution.node_count < 4 : !spacing_good) {
    refuse(name, "the nodes would be too few or without number",
           "node spacing must lie in (0, 0.5] diameters, and a node count must be at least 4",
           "Leave it out for nodes a tenth of a diameter apart.");
  }
}

/// A mesh in the body frame and what it stands for.
struct Surface {
  TriangleMesh mesh;
  TriangleBvh bvh;
  SurfaceKind kind;
  std::vector<Crease> creases;          // empty where edges mean nothing
  std::optional<CurvedSurface> smooth;  // where vertices lie on one

  Surface(TriangleMesh body_mesh, SurfaceKind surface_kind)
      : mesh{std::move(body_mesh)}, bvh{mesh}, kind{surface_kind} {
    if (kind == SurfaceKind::polyhedron || kind == SurfaceKind::solid) creases = creases_of(mesh);
    if (kind == SurfaceKind::curved || kind == SurfaceKind::solid) smooth.emplace(mesh);
  }
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
};

/// Nodes on sharp edges and corners, as far apart as `count` nodes on the whole surface are;
/// farther where they would be more than a third of all.
OrientedPoints nodes_on_edges(const Surface& surface, double area, std::size_t count) {
  OrientedPoints nodes;
  double spacing = std::sqrt(area / static_cast<double>(count));
  do {
    nodes.position = points_on_creases(surface.mesh, surface.creases, spacing);
    spacing *= 1.2;
  } while (3 * nodes.position.size() > count);
  nodes.normal.reserve(nodes.position.size());
  for (const Vec3& p : nodes.position) {
    nodes.normal.push_back(normalized(surface.bvh.pseudo_normal(surface.bvh.closest_point(p))));
  }
  return nodes;
}

/// Adds nodes, their areas and clusters. The first `on_edges` of `spread` lie on edges.
void set_nodes(Shape& shape, const Surface& surface, const SurfaceSampler& sampler,
               const OrientedPoints& spread, std::size_t on_edges) {
  OrientedPoints nodes;
  std::size_t lost = 0;
  for (std::size_t n = 0; n < spread.size(); ++n) {
    Vec3 place = spread.position[n];
    if (n >= on_edges) {
      const auto on_grid = project_to_surface(shape.level_set, place, spread.normal[n]);
      if (!on_grid) ++lost;  // a part too thin for the grid: other grains do not see it
      if (surface.kind == SurfaceKind::sampled) {
        if (!on_grid) continue;
        place = *on_grid;
      } else if (surface.smooth) {
        place = surface.smooth->point(surface.bvh.closest_point(place));
      }
    }
    nodes.position.push_back(place);
    nodes.normal.push_back(spread.normal[n]);
  }
  if (static_cast<double>(lost) > largest_lost_share * static_cast<double>(spread.size())) {
    refuse(shape.name, "the grid is too coarse for the thinnest parts",
           fmt::format("{} of {} nodes find no surface on it", lost, spread.size()),
           "Give more voxels per diameter.");
  }
  SurfaceNodes unsorted;
  const std::size_t per_node =
      nodes.size() < many_nodes ? area_samples_per_node : area_samples_per_node / 2;
  unsorted.area = tributary_areas(nodes, sampler, per_node * nodes.size(), on_edges);
  for (const Vec3& p : nodes.position) {
    unsorted.x.push_back(p.x);
    unsorted.y.push_back(p.y);
    unsorted.z.push_back(p.z);
  }
  shape.nodes = in_compact_order(unsorted);
  shape.clusters = make_clusters(shape.nodes);
}

/// Adds nodes, areas, clusters and the bounds that follow from them and the grid.
void add_nodes(Shape& shape, const Surface& surface, std::size_t count) {
  const std::vector<std::uint32_t> order = surface.bvh.tree_order();
  const SurfaceSampler sampler{surface.mesh, order};
  const OrientedPoints on_edges = nodes_on_edges(surface, sampler.area(), count);
  set_nodes(shape, surface, sampler, spread_points(sampler, surface.bvh, count, on_edges),
            on_edges.size());
  shape.lipschitz = lipschitz_constant(shape.level_set);
  double farthest_node = 0;
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    farthest_node = std::max(farthest_node, norm(shape.nodes.position(n)));
  }
  shape.bounding_radius = inside_radius(shape.level_set, farthest_node);
}

}  // namespace

LevelSet sample_signed_distance(const TriangleBvh& bvh, double spacing) {
  LevelSet grid = grid_around(bvh.bounds(), spacing);
  grid.values.resize(grid.index(0, 0, grid.dims[2]));
  parallel_for(static_cast<std::size_t>(grid.dims[2]), 1, [&](std::size_t slab) {
    const auto k = static_cast<std::int32_t>(slab);
    for (std::int32_t j = 0; j < grid.dims[1]; ++j) {
      // The last vertex's closest point is near this one's, so its distance bounds the search. The
      // bound only saves time.
      std::optional<ClosestPoint> closest;
      for (std::int32_t i = 0; i < grid.dims[0]; ++i) {
        const Vec3 vertex = grid.vertex_body(i, j, k);
        if (closest) {
          const double bound = norm(vertex - closest->point) * (1 + 1e-12);
          closest = bvh.closest_point_within(vertex, bound);
        }
        if (!closest) closest = bvh.closest_point(vertex);
        grid.values[grid.index(i, j, k)] =
            static_cast<float>(bvh.signed_distance(vertex, *closest));
      }
    }
  });
  return grid;
}

std::optional<Vec3> project_to_surface(const LevelSetView& grid, const Vec3& start,
                                       const Vec3& normal) {
  const double reach = 2 * grid.spacing;
  const double tolerance = 1e-12 * grid.spacing;
  Vec3 point = start;
  for (int round = 0; round < 30; ++round) {
    const LevelSetView::Sample here = grid.sample(point);
    if (!here.inside_grid || norm(point - start) > reach) break;
    if (std::abs(here.phi) <= tolerance) return point;
    const double slope = squared_norm(here.gradient_body);
    if (!(slope > 0.01)) break;
    point -= (here.phi / slope) * here.gradient_body;
  }
  // Newton may circle about the border between two cells. Along a line phi is continuous.
  const auto phi_at = [&](double s) {
    const LevelSetView::Sample sample = grid.sample(start + s * normal);
    return sample.inside_grid ? sample.phi : grid.spacing;
  };
  double outer = 0.5 * grid.spacing;
  while (outer < reach && !(phi_at(outer) >= 0)) outer += 0.25 * grid.spacing;
  double inner = outer;
  while (inner > -reach && !(phi_at(inner) < 0)) inner -= 0.05 * grid.spacing;
  if (!(phi_at(outer) >= 0) || !(phi_at(inner) < 0)) return std::nullopt;
  outer = inner + 0.05 * grid.spacing;
  for (int round = 0; round < 60; ++round) {
    const double middle = 0.5 * (inner + outer);
    (phi_at(middle) < 0 ? inner : outer) = middle;
  }
  return start + inner * normal;
}

Shape build_shape(const TriangleMesh& mesh, const ShapeResolution& resolution,
                  const std::string& name, SurfaceKind kind) {
  const SolidProperties solid = solid_properties(mesh);
  if (!(solid.volume > 0) || !std::isfinite(solid.volume)) {
    refuse(name, "the surface encloses no volume", fmt::format("{} m^3", solid.volume),
           "Give a closed surface whose triangles face outward.");
  }
  const double diameter = portable::cbrt(6 * solid.volume / std::numbers::pi);
  check_resolution(resolution, diameter, name);
  const PrincipalFrame frame = principal_frame(solid);
  const Surface surface{to_frame(mesh, frame), kind};

  Shape shape;
  shape.name = name;
  shape.mass = {solid.volume, frame.moments};
  shape.level_set = transformed_distance(
      surface.mesh, surface.bvh,
      resolution.voxel_size.value_or(diameter / resolution.voxels_per_diameter),
      resolution.storage);
  const double grid_volume = grid_properties(shape.level_set).volume;
  if (!(std::abs(grid_volume / solid.volume - 1) <= largest_grid_error)) {
    refuse(name, "the grid is too coarse for this shape",
           fmt::format("counting on it gives {:.1f} % of the volume",
                       100 * grid_volume / solid.volume),
           "Give more voxels per diameter.");
  }
  shape.descriptors = describe_shape(surface.mesh, surface.bvh, solid, shape.level_set);
  if (surface.smooth) measure_to_curved_surface(shape.level_set, surface.bvh, *surface.smooth);
  remove_interpolation_bias(shape.level_set, surface.mesh, surface.creases);
  const double node_area = resolution.node_spacing * diameter * resolution.node_spacing * diameter;
  const double wanted =
      resolution.node_count ? *resolution.node_count : std::ceil(solid.surface_area / node_area);
  add_nodes(shape, surface, static_cast<std::size_t>(wanted));
  if (resolution.storage == ShapeStorage::band) round_to_band(shape);
  return shape;
}

}  // namespace reckon
