// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/distance_transform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "reckon/avatar/shape_builder.hpp"
#include "reckon/core/error.hpp"

namespace reckon {
namespace {

constexpr double padding = 2.25;   // beyond the surface's bounding box [spacings]
constexpr double rounding = 1e-6;  // relative; by which tests that only save time are kept safe
constexpr float buckets_per_spacing = 4;
constexpr float sideways = 0.75;  // [spacings]
constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// A grid vertex's closest point as far as it is known.
struct Foot {
  float x{0}, y{0}, z{0};  // from the grid's vertex (0, 0, 0) [spacings]
  float squared{std::numeric_limits<float>::infinity()};  // its distance [spacings^2]
  std::uint32_t triangle{none};
  bool inside{false};  // the vertex, and so all that the closest point is handed on to
};

struct Ball {
  Vec3 center;
  double radius;
};

/// The smallest ball around a triangle, or a little more.
Ball ball_around(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double ab = squared_norm(b - a);
  const double bc = squared_norm(c - b);
  const double ca = squared_norm(a - c);
  const double longest = std::max({ab, bc, ca});
  Vec3 center;
  if (2 * longest >= ab + bc + ca) {  // no acute triangle
    center = longest == ab ? 0.5 * (a + b) : longest == bc ? 0.5 * (b + c) : 0.5 * (c + a);
  } else {  // the circumscribed circle's, in barycentric coordinates
    const double wa = bc * (ca + ab - bc);
    const double wb = ca * (ab + bc - ca);
    const double wc = ab * (bc + ca - ab);
    center = (wa * a + wb * b + wc * c) / (wa + wb + wc);
  }
  const double squared =
      std::max({squared_norm(a - center), squared_norm(b - center), squared_norm(c - center)});
  return {center, std::sqrt(squared) * (1 + rounding)};
}

class Transform {
 public:
  Transform(const TriangleMesh& mesh, const TriangleBvh& bvh, double spacing)
      : mesh_{mesh}, bvh_{bvh}, grid_{grid_around(bvh.bounds(), spacing)} {
    stride_ = {1, grid_.index(0, 1, 0), grid_.index(0, 0, 1)};
  }

  LevelSet run() {
    const std::size_t count = grid_.index(0, 0, grid_.dims[2]);
    const double band = exact_band * grid_.spacing;
    squared_.assign(count, band * band);
    bound_.assign(count, static_cast<float>(band * band * (1 + rounding)));
    foot_.assign(count, {});
    bound_by_vertices();
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) rasterise(t);
    close_band();
    spread();
    measure_beyond();
    return std::move(grid_);
  }

 private:
  struct Span {
    std::int32_t low;
    std::int32_t high;
  };
  /// The vertices between two places along an axis.
  [[nodiscard]] Span vertices_between(double low, double high, int axis) const {
    const auto a = static_cast<std::size_t>(axis);
    const double to_place = 1 / grid_.spacing;
    const double first = std::ceil((low - grid_.origin_body[axis]) * to_place - rounding);
    const double last = std::floor((high - grid_.origin_body[axis]) * to_place + rounding);
    const double end = grid_.dims[a] - 1;
    return {static_cast<std::int32_t>(std::clamp(first, 0.0, end + 1)),
            static_cast<std::int32_t>(std::clamp(last, -1.0, end))};
  }

  /// The corners of triangles are near enough to most closest points to spare most triangles.
  void bound_by_vertices() {
    std::vector<bool> used(mesh_.vertices.size(), false);
    for (const TriangleMesh::Triangle& t : mesh_.triangles) {
      for (const std::uint32_t corner : t) used[corner] = true;
    }
    const double band = exact_band * grid_.spacing;
    for (std::size_t p = 0; p < used.size(); ++p) {
      if (!used[p]) continue;
      const Vec3& point = mesh_.vertices[p];
      const Span ks = vertices_between(point.z - band, point.z + band, 2);
      const Span js = vertices_between(point.y - band, point.y + band, 1);
      const Span is = vertices_between(point.x - band, point.x + band, 0);
      for (std::int32_t k = ks.low; k <= ks.high; ++k) {
        for (std::int32_t j = js.low; j <= js.high; ++j) {
          const Vec3 start = grid_.vertex_body(0, j, k) - point;
          const double yz = start.y * start.y + start.z * start.z;
          float* const row = bound_.data() + grid_.index(0, j, k);
          for (std::int32_t i = is.low; i <= is.high; ++i) {
            const double x = start.x + i * grid_.spacing;
            row[i] = std::min(row[i], static_cast<float>((x * x + yz) * (1 + rounding)));
          }
        }
      }
    }
  }

  /// Offers a triangle to all vertices in the band around it. In the order of their numbers, so
  /// that of equally close triangles the first wins, as in TriangleBvh.
  void rasterise(std::uint32_t t) {
    const TriangleMesh::Triangle& corners = mesh_.triangles[t];
    const Vec3& a = mesh_.vertices[corners[0]];
    const Vec3& b = mesh_.vertices[corners[1]];
    const Vec3& c = mesh_.vertices[corners[2]];
    const Ball ball = ball_around(a, b, c);
    const Vec3 normal = normalized(cross(b - a, c - a));
    const double reach = ball.radius + exact_band * grid_.spacing * (1 + rounding);
    const Span ks = vertices_between(ball.center.z - reach, ball.center.z + reach, 2);
    const Span js = vertices_between(ball.center.y - reach, ball.center.y + reach, 1);
    for (std::int32_t k = ks.low; k <= ks.high; ++k) {
      for (std::int32_t j = js.low; j <= js.high; ++j) {
        const Vec3 start = grid_.vertex_body(0, j, k) - ball.center;
        const double yz = start.y * start.y + start.z * start.z;
        if (!(yz <= reach * reach)) continue;
        const double half = std::sqrt(reach * reach - yz);
        const double start_height = dot(normal, start);
        const Span is = vertices_between(ball.center.x - half, ball.center.x + half, 0);
        for (std::int32_t i = is.low; i <= is.high; ++i) {
          const std::size_t v = grid_.index(i, j, k);
          // Above the plane by the height, and beside the triangle by what is farther than the
          // ball.
          const double x = start.x + i * grid_.spacing;
          const double height = start_height + normal.x * i * grid_.spacing;
          const double room = double{bound_[v]} - height * height;
          if (room < 0) continue;
          const double beside = std::sqrt(room) + ball.radius;
          if (x * x + yz - height * height > beside * beside * (1 + rounding)) continue;
          const ClosestPoint closest =
              closest_point_on_triangle(grid_.vertex_body(i, j, k), a, b, c);
          if (!(closest.squared_distance < squared_[v])) continue;
          squared_[v] = closest.squared_distance;
          bound_[v] =
              std::min(bound_[v], static_cast<float>(closest.squared_distance * (1 + rounding)));
          foot_[v].triangle = t;
        }
      }
    }
  }

  [[nodiscard]] ClosestPoint closest_on(std::uint32_t t, const Vec3& vertex) const {
    const TriangleMesh::Triangle& corners = mesh_.triangles[t];
    ClosestPoint closest = closest_point_on_triangle(
        vertex, mesh_.vertices[corners[0]], mesh_.vertices[corners[1]], mesh_.vertices[corners[2]]);
    closest.triangle = t;
    return closest;
  }

  template <class Visit>
  void for_each_vertex(Visit&& visit) const {
    std::size_t v = 0;
    for (std::int32_t k = 0; k < grid_.dims[2]; ++k) {
      for (std::int32_t j = 0; j < grid_.dims[1]; ++j) {
        for (std::int32_t i = 0; i < grid_.dims[0]; ++i, ++v) visit(v, grid_.vertex_body(i, j, k));
      }
    }
  }

  /// Values and closest points of the band.
  void close_band() {
    grid_.values.resize(foot_.size());
    for_each_vertex([&](std::size_t v, const Vec3& vertex) {
      Foot& foot = foot_[v];
      if (foot.triangle == none) return;
      const ClosestPoint closest = closest_on(foot.triangle, vertex);
      grid_.values[v] = static_cast<float>(bvh_.signed_distance(vertex, closest));
      foot.inside = grid_.values[v] < 0;
      foot.squared = 0;  // nothing improves it
      const Vec3 place = (closest.point - grid_.origin_body) / grid_.spacing;
      foot.x = static_cast<float>(place.x);
      foot.y = static_cast<float>(place.y);
      foot.z = static_cast<float>(place.z);
    });
  }

  /// Hands closest points on from neighbour to neighbour, nearest to the surface first.
  void spread() {
    std::vector<std::vector<std::size_t>> queue(1);
    for (std::size_t v = 0; v < foot_.size(); ++v) {
      if (foot_[v].triangle != none) queue.front().push_back(v);
    }
    std::vector<bool> done(foot_.size(), false);
    for (std::size_t bucket = 0; bucket < queue.size(); ++bucket) {
      for (std::size_t n = 0; n < queue[bucket].size(); ++n) {  // it may grow meanwhile
        const std::size_t v = queue[bucket][n];
        if (done[v]) continue;
        done[v] = true;
        const auto i = static_cast<std::int32_t>(v % stride_[1]);
        const auto j = static_cast<std::int32_t>(v % stride_[2] / stride_[1]);
        const auto k = static_cast<std::int32_t>(v / stride_[2]);
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
              queue[place].push_back(to);
            }
          }
        }
      }
      std::vector<std::size_t>{}.swap(queue[bucket]);
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
    const Foot& foot = foot_[neighbour];
    const float x = static_cast<float>(i) - foot.x;
    const float y = static_cast<float>(j) - foot.y;
    const float z = static_cast<float>(k) - foot.z;
    const float squared = x * x + y * y + z * z;
    if (!(squared < foot_[v].squared)) return 0;
    // More than exact_band away, the surface does not pass between the two.
    foot_[v] = foot;
    foot_[v].squared = squared;
    return static_cast<std::size_t>(buckets_per_spacing * std::sqrt(squared)) + 1;
  }

  void measure_beyond() {
    for_each_vertex([&](std::size_t v, const Vec3& vertex) {
      if (foot_[v].squared == 0) return;
      const ClosestPoint closest = closest_on(foot_[v].triangle, vertex);
      const auto distance = static_cast<float>(std::sqrt(closest.squared_distance));
      grid_.values[v] = foot_[v].inside ? -distance : distance;
    });
  }

  const TriangleMesh& mesh_;
  const TriangleBvh& bvh_;
  LevelSet grid_;
  std::array<std::size_t, 3> stride_{};
  std::vector<double> squared_;  // distance of the closest triangle yet [m^2]
  std::vector<float> bound_;     // an upper bound of it
  std::vector<Foot> foot_;
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

LevelSet transformed_distance(const TriangleMesh& mesh, const TriangleBvh& bvh, double spacing) {
  return Transform{mesh, bvh, spacing}.run();
}

}  // namespace reckon
