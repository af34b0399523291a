// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/distance_transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "reckon/avatar/closest_triangles.hpp"
#include "reckon/avatar/shape_builder.hpp"
#include "reckon/core/error.hpp"

namespace reckon {
namespace {

constexpr double padding = 2.25;            // beyond the surface's bounding box [spacings]
constexpr double cell_diagonal = 1.732051;  // or a little more [spacings]
constexpr float buckets_per_spacing = 4;
constexpr float sideways = 0.75;  // [spacings]

class Transform {
 public:
  Transform(const TriangleMesh& mesh, const TriangleBvh& bvh, double spacing, ShapeStorage storage)
      : mesh_{mesh}, bvh_{bvh}, storage_{storage}, grid_{grid_around(bvh.bounds(), spacing)} {
    band_ = spacing * (storage == ShapeStorage::band ? double{band_half_width} : exact_band);
  }

  LevelSet run() {
    triangle_ = closest_triangles(mesh_, grid_, band_);
    grid_.values.resize(triangle_.size());
    foot_.resize(triangle_.size());
    close_band();
    spread();
    measure_beyond();
    return std::move(grid_);
  }

 private:
  /// The closest point of a grid vertex as far as it is known.
  struct Foot {
    float x, y, z;  // from the grid's vertex (0, 0, 0) [spacings]
    float squared;  // its distance [spacings^2]; 0 where nothing is to be improved
  };

  [[nodiscard]] ClosestPoint closest_on(std::uint32_t t, const Vec3& vertex) const {
    const TriangleMesh::Triangle& corners = mesh_.triangles[t];
    ClosestPoint closest = closest_point_on_triangle(
        vertex, mesh_.vertices[corners[0]], mesh_.vertices[corners[1]], mesh_.vertices[corners[2]]);
    closest.triangle = t;
    return closest;
  }

  template <class Visit>
  void for_each_row(Visit&& visit) const {
    for (std::int32_t k = 0; k < grid_.dims[2]; ++k) {
      for (std::int32_t j = 0; j < grid_.dims[1]; ++j) visit(j, k, grid_.index(0, j, k));
    }
  }

  /// Values of the band, closest points where others beyond it may learn from them, and signs of
  /// all others: from one vertex of a row to the next the surface passes only within the band.
  void close_band() {
    const bool all_outside = storage_ == ShapeStorage::full;
    const auto outermost = static_cast<float>(band_half_width * grid_.spacing);
    for_each_row([&](std::int32_t j, std::int32_t k, std::size_t row) {
      bool inside = false;
      for (std::int32_t i = 0; i < grid_.dims[0]; ++i) {
        const std::size_t v = row + static_cast<std::size_t>(i);
        Foot& foot = foot_[v];
        foot.squared = 0;
        if (triangle_[v] == no_triangle) {
          const bool sought = inside || all_outside;
          grid_.values[v] = inside ? -outermost : outermost;
          if (sought) foot.squared = std::numeric_limits<float>::infinity();
          continue;
        }
        const Vec3 vertex = grid_.vertex_body(i, j, k);
        const ClosestPoint closest = closest_on(triangle_[v], vertex);
        const double phi = bvh_.signed_distance(vertex, closest);
        grid_.values[v] = static_cast<float>(phi);
        inside = grid_.values[v] < 0;
        if (std::abs(phi) < band_ - cell_diagonal * grid_.spacing || !(inside || all_outside)) {
          continue;
        }
        const Vec3 place = (closest.point - grid_.origin_body) / grid_.spacing;
        foot.x = static_cast<float>(place.x);
        foot.y = static_cast<float>(place.y);
        foot.z = static_cast<float>(place.z);
        seeds_.push_back(static_cast<std::uint32_t>(v));
      }
    });
  }

  /// Propagates closest points from neighbour to neighbour, nearest to the surface first.
  void spread() {
    const auto row = static_cast<std::uint32_t>(grid_.dims[0]);
    const std::uint32_t layer = row * static_cast<std::uint32_t>(grid_.dims[1]);
    std::vector<std::vector<std::uint32_t>> queue(1);
    queue.front().swap(seeds_);
    std::vector<bool> done(foot_.size(), false);
    for (std::size_t bucket = 0; bucket < queue.size(); ++bucket) {
      for (std::size_t n = 0; n < queue[bucket].size(); ++n) {  // it may grow meanwhile
        const std::uint32_t v = queue[bucket][n];
        if (done[v]) continue;
        done[v] = true;
        const auto i = static_cast<std::int32_t>(v % row);
        const auto j = static_cast<std::int32_t>(v % layer / row);
        const auto k = static_cast<std::int32_t>(v / layer);
        const std::array<Steps, 3> steps{steps_away(foot_[v].x, i, grid_.dims[0]),
                                         steps_away(foot_[v].y, j, grid_.dims[1]),
                                         steps_away(foot_[v].z, k, grid_.dims[2])};
        for (std::int32_t z = steps[2].low; z <= steps[2].high; ++z) {
          for (std::int32_t y = steps[1].low; y <= steps[1].high; ++y) {
            for (std::int32_t x = steps[0].low; x <= steps[0].high; ++x) {
              const std::size_t to = grid_.index(i + x, j + y, k + z);
              const std::size_t place = offer(to, v, i + x, j + y, k + z);
              if (place == 0) continue;
              if (place >= queue.size()) queue.resize(place + 1);
              queue[place].push_back(static_cast<std::uint32_t>(to));
            }
          }
        }
      }
      std::vector<std::uint32_t>{}.swap(queue[bucket]);
    }
  }
  struct Steps {
    std::int32_t low;
    std::int32_t high;
  };
  /// Steps along an axis that do not lead back towards a closest point.
  static Steps steps_away(float foot, std::int32_t at, std::int32_t dim) {
    const float offset = static_cast<float>(at) - foot;
    return {offset < sideways && at > 0 ? -1 : 0, offset > -sideways && at + 1 < dim ? 1 : 0};
  }
  /// Where a vertex's place in the queue is now, if the closest point of a neighbour is nearer than
  /// its own; else 0.
  std::size_t offer(std::size_t v, std::size_t neighbour, std::int32_t i, std::int32_t j,
                    std::int32_t k) {
    if (foot_[v].squared == 0) return 0;
    const Foot& foot = foot_[neighbour];
    const float x = static_cast<float>(i) - foot.x;
    const float y = static_cast<float>(j) - foot.y;
    const float z = static_cast<float>(k) - foot.z;
    const float squared = x * x + y * y + z * z;
    if (!(squared < foot_[v].squared)) return 0;
    foot_[v] = {foot.x, foot.y, foot.z, squared};
    triangle_[v] = triangle_[neighbour];
    return static_cast<std::size_t>(buckets_per_spacing * std::sqrt(squared)) + 1;
  }

  void measure_beyond() {
    for_each_row([&](std::int32_t j, std::int32_t k, std::size_t row) {
      for (std::int32_t i = 0; i < grid_.dims[0]; ++i) {
        const std::size_t v = row + static_cast<std::size_t>(i);
        if (foot_[v].squared == 0) continue;
        const double distance =
            storage_ == ShapeStorage::band
                ? grid_.spacing * std::sqrt(double{foot_[v].squared})
                : std::sqrt(closest_on(triangle_[v], grid_.vertex_body(i, j, k)).squared_distance);
        grid_.values[v] = static_cast<float>(std::copysign(distance, double{grid_.values[v]}));
      }
    });
  }

  const TriangleMesh& mesh_;
  const TriangleBvh& bvh_;
  ShapeStorage storage_;
  LevelSet grid_;
  double band_{0};  // within which distances are exact [m]
  std::vector<std::uint32_t> triangle_;
  std::vector<Foot> foot_;
  std::vector<std::uint32_t> seeds_;
};

}  // namespace

LevelSet grid_around(const BoundingBox& bounds, double spacing) {
  LevelSet grid;
  grid.spacing = spacing;
  const Vec3 center = 0.5 * (bounds.low + bounds.high);
  const Vec3 extent = bounds.high - bounds.low;
  double count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double cells = std::ceil(extent[axis] / spacing + 2 * padding);
    count *= cells + 1;
    if (!(count <= largest_grid)) {
      throw Error{{.place = {},
                   .problem = "the grid would be too large",
                   .reason = fmt::format("more than {:.0e} vertices", largest_grid),
                   .fix = "Give fewer voxels per diameter or a larger voxel."}};
    }
    grid.dims[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(cells) + 1;
    grid.origin_body[axis] = center[axis] - 0.5 * cells * spacing;
  }
  return grid;
}

LevelSet transformed_distance(const TriangleMesh& mesh, const TriangleBvh& bvh, double spacing,
                              ShapeStorage storage) {
  return Transform{mesh, bvh, spacing, storage}.run();
}

}  // namespace reckon
