// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/report/display_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "reckon/avatar/surface_extraction.hpp"

namespace reckon {
namespace {

/// Where a point outside the grid counts as this far outside the grain: far enough to close the
/// surface, independent of the edge of the grid.
double value_at(const LevelSetView& grid, const Vec3& point_body) {
  const LevelSetView::Sample sample = grid.sample(point_body);
  return sample.inside_grid ? sample.phi : grid.spacing;
}

/// The grid seen at a wider spacing, with a rim of one vertex outside of it.
LevelSet resampled(const LevelSetView& grid, double spacing) {
  LevelSet coarse;
  coarse.spacing = spacing;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double length = grid.spacing * (grid.dims[a] - 1);
    const auto cells = static_cast<std::int32_t>(std::ceil(length / spacing)) + 2;
    coarse.dims[a] = cells + 1;
    coarse.origin_body[axis] = grid.origin_body[axis] + 0.5 * (length - spacing * cells);
  }
  coarse.values.reserve(coarse.index(0, 0, coarse.dims[2]));
  for (std::int32_t k = 0; k < coarse.dims[2]; ++k) {
    for (std::int32_t j = 0; j < coarse.dims[1]; ++j) {
      for (std::int32_t i = 0; i < coarse.dims[0]; ++i) {
        coarse.values.push_back(static_cast<float>(value_at(grid, coarse.vertex_body(i, j, k))));
      }
    }
  }
  return coarse;
}

/// Newton's steps along the gradient, none longer than `longest`.
Vec3 onto_surface(const LevelSetView& grid, Vec3 point, double longest) {
  constexpr int steps = 4;
  for (int n = 0; n < steps; ++n) {
    const LevelSetView::Sample sample = grid.sample(point);
    const double slope = squared_norm(sample.gradient_body);
    if (!sample.inside_grid || !(slope > 1e-6)) break;
    const Vec3 move = (-sample.phi / slope) * sample.gradient_body;
    const double length = norm(move);
    point += length > longest ? (longest / length) * move : move;
  }
  return point;
}

/// Means of the triangles' normals weighted by area: they follow what is drawn, where the gradient
/// of a coarse grid would show its cells.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> normals(mesh.vertices.size());
  for (const TriangleMesh::Triangle& triangle : mesh.triangles) {
    const Vec3 twice_area = doubled_area_vector(mesh, triangle);
    for (const std::uint32_t corner : triangle) normals[corner] += twice_area;
  }
  for (Vec3& normal : normals) {
    const double length = norm(normal);
    normal = length > 0 ? (1 / length) * normal : Vec3{0, 0, 1};
  }
  return normals;
}

}  // namespace

DisplayMesh display_mesh(const LevelSetView& grid, std::size_t triangles) {
  TriangleMesh mesh = extract_surface(grid);
  const std::size_t native = mesh.triangles.size();
  if (native > triangles) {
    // The number of triangles goes with the inverse square of the spacing.
    const double widening = std::sqrt(static_cast<double>(native) /
                                      static_cast<double>(std::max<std::size_t>(triangles, 1)));
    const double thinnest =
        grid.spacing * (*std::min_element(grid.dims.begin(), grid.dims.end()) - 1);
    const double spacing = std::min(widening * grid.spacing, thinnest / 4);
    TriangleMesh coarse = extract_surface(resampled(grid, spacing));
    if (!coarse.triangles.empty()) mesh = std::move(coarse);
    for (Vec3& vertex : mesh.vertices) vertex = onto_surface(grid, vertex, 0.5 * spacing);
  }
  DisplayMesh display{std::move(mesh), {}};
  display.normals_unit = vertex_normals(display.mesh);
  return display;
}

}  // namespace reckon
