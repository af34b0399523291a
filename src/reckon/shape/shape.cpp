// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/shape/shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace reckon {

double lipschitz_constant(const LevelSet& grid) {
  double steepest_squared = 0;
  const auto nx = static_cast<std::size_t>(grid.dims[0]);
  const auto nxy = nx * static_cast<std::size_t>(grid.dims[1]);
  for (std::int32_t k = 0; k + 1 < grid.dims[2]; ++k) {
    for (std::int32_t j = 0; j + 1 < grid.dims[1]; ++j) {
      for (std::int32_t i = 0; i + 1 < grid.dims[0]; ++i) {
        const std::size_t b = static_cast<std::size_t>(i) + nx * static_cast<std::size_t>(j) +
                              nxy * static_cast<std::size_t>(k);
        std::array<double, 8> corner;  // bit 0: one step along x, bit 1: y, bit 2: z
        for (std::size_t c = 0; c < 8; ++c) {
          corner[c] = grid.values[b + (c & 1) + (c >> 1 & 1) * nx + (c >> 2) * nxy];
        }
        if (*std::max_element(corner.begin(), corner.end()) < 0) continue;
        for (std::size_t c = 0; c < 8; ++c) {
          const Vec3 slopes{corner[c ^ 1] - corner[c], corner[c ^ 2] - corner[c],
                            corner[c ^ 4] - corner[c]};
          steepest_squared = std::max(steepest_squared, squared_norm(slopes));
        }
      }
    }
  }
  return std::sqrt(steepest_squared) / grid.spacing;
}

std::vector<NodeCluster> make_clusters(const SurfaceNodes& nodes, std::uint32_t per_cluster) {
  std::vector<NodeCluster> clusters;
  const auto total = static_cast<std::uint32_t>(nodes.size());
  for (std::uint32_t first = 0; first < total; first += per_cluster) {
    const std::uint32_t count = std::min(per_cluster, total - first);
    Vec3 low = nodes.position(first);
    Vec3 high = low;
    for (std::uint32_t n = first; n < first + count; ++n) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], nodes.position(n)[axis]);
        high[axis] = std::max(high[axis], nodes.position(n)[axis]);
      }
    }
    const Vec3 center = 0.5 * (low + high);
    double radius = 0;
    for (std::uint32_t n = first; n < first + count; ++n) {
      radius = std::max(radius, norm(nodes.position(n) - center));
    }
    clusters.push_back({center, radius * (1 + 1e-12), first, count});
  }
  return clusters;
}

void round_to_band(Shape& shape) {
  decode_band(encode_band(shape.level_set), shape.level_set);
  for (auto* const column : {&shape.nodes.x, &shape.nodes.y, &shape.nodes.z, &shape.nodes.area}) {
    for (double& number : *column) number = static_cast<float>(number);
  }
  shape.clusters = make_clusters(shape.nodes);
  shape.lipschitz = lipschitz_constant(shape.level_set);
  // Farther than half a count and half a unit in the last place move the surface and the nodes.
  shape.bounding_radius += 1e-4 * shape.level_set.spacing;
  shape.storage = ShapeStorage::band;
}

ShapeOutline outline_without_grid(const Shape& shape) {
  return {shape.level_set.dims,
          shape.level_set.spacing,
          shape.level_set.origin_body,
          shape.nodes.size(),
          shape.mass,
          shape.bounding_radius,
          shape.lipschitz,
          shape.sphere_radius,
          shape.storage,
          0};
}

ShapeOutline outline_of(const Shape& shape) {
  ShapeOutline outline = outline_without_grid(shape);
  if (shape.storage == ShapeStorage::band && !shape.level_set.values.empty()) {
    outline.band_words = encode_band(shape.level_set).size();
  }
  return outline;
}

std::uint64_t ShapeOutline::memory() const {
  const std::uint64_t clusters = (nodes + nodes_per_cluster - 1) / nodes_per_cluster;
  const bool in_band = storage == ShapeStorage::band;
  return (in_band ? band_words * sizeof(LevelSetBand::Word) : values() * sizeof(float)) +
         nodes * 4 * (in_band ? sizeof(float) : sizeof(double)) + clusters * sizeof(NodeCluster);
}

ShapeView::ShapeView(const ShapeOutline& outline)
    : level_set{outline.dims, outline.spacing, outline.origin_body, {}},
      mass{outline.mass},
      bounding_radius{outline.bounding_radius},
      lipschitz{outline.lipschitz},
      sphere_radius{outline.sphere_radius} {}

ShapeView::ShapeView(const Shape& shape)
    : level_set{shape.level_set},
      clusters{shape.clusters},
      mass{shape.mass},
      bounding_radius{shape.bounding_radius},
      lipschitz{shape.lipschitz},
      sphere_radius{shape.sphere_radius} {
  set_nodes({std::span{shape.nodes.x}, std::span{shape.nodes.y}, std::span{shape.nodes.z},
             std::span{shape.nodes.area}});
}

void ShapeView::set_nodes(const SurfaceNodesView& these) {
  nodes = these;
  double sum = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) sum += nodes.area[n];
  mean_node_area = nodes.size() > 0 ? sum / static_cast<double>(nodes.size()) : 0;
}

}  // namespace reckon
