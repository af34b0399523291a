// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/surface_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "reckon/shape/node_order.hpp"

namespace reckon {
namespace {

constexpr std::size_t samples_per_point = 48;
constexpr int relaxation_rounds = 50;
// Each point goes farther than to the middle of its share, which settles long waves sooner.
constexpr double over_relaxation = 1.7;
constexpr int over_relaxed_rounds = 45;
constexpr double opposite_cosine = -0.5;

Vec3 area_vector(const TriangleMesh& mesh, const TriangleMesh::Triangle& t) {
  const Vec3& a = mesh.vertices[t[0]];
  return 0.5 * cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
}

/// Finds the nearest of some oriented points, by cells of about one point each.
class NearestPoint {
 public:
  explicit NearestPoint(const OrientedPoints& points) : points_{points} {
    BoundingBox box;
    for (const Vec3& p : points.position) box.include(p);
    low_ = box.low;
    const Vec3 extent = box.high - box.low;
    const double longest = std::max({extent.x, extent.y, extent.z});
    // Points lie on a surface: their spacing is about the box's size over the root of their number.
    cell_ = std::max(longest / std::max(1.0, std::sqrt(static_cast<double>(points.size()) / 3)),
                     std::numeric_limits<double>::min());
    for (int axis = 0; axis < 3; ++axis) {
      dims_[static_cast<std::size_t>(axis)] = static_cast<int>(extent[axis] / cell_) + 1;
    }
    first_.assign(static_cast<std::size_t>(dims_[0]) * static_cast<std::size_t>(dims_[1]) *
                          static_cast<std::size_t>(dims_[2]) +
                      1,
                  0);
    for (const Vec3& p : points.position) ++first_[cell_of(p) + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    members_.resize(points.size());
    for (std::uint32_t n = 0; n < points.size(); ++n) {
      members_[next[cell_of(points.position[n])]++] = n;
    }
  }

  /// Ties go to the lower number. When all points are turned away, the nearest of all.
  [[nodiscard]] std::uint32_t find(const Vec3& position, const Vec3& normal) const {
    const Best facing = search(position, [&](std::uint32_t n) {
      return dot(points_.normal[n], normal) >= opposite_cosine;
    });
    if (facing.squared_distance < std::numeric_limits<double>::infinity()) return facing.point;
    return search(position, [](std::uint32_t) { return true; }).point;
  }

 private:
  struct Best {
    double squared_distance{std::numeric_limits<double>::infinity()};
    std::uint32_t point{0};
  };

  [[nodiscard]] int coordinate(const Vec3& p, int axis) const {
    const double g = (p[axis] - low_[axis]) / cell_;
    const int last = dims_[static_cast<std::size_t>(axis)] - 1;
    return g >= last ? last : g > 0 ? static_cast<int>(g) : 0;
  }
  [[nodiscard]] std::size_t cell_index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(dims_[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(dims_[1]) * static_cast<std::size_t>(k));
  }
  [[nodiscard]] std::size_t cell_of(const Vec3& p) const {
    return cell_index(coordinate(p, 0), coordinate(p, 1), coordinate(p, 2));
  }

  /// Looks at shells of cells around the position's own until no closer point can follow.
  template <class Accept>
  [[nodiscard]] Best search(const Vec3& position, Accept&& accept) const {
    const std::array<int, 3> center{coordinate(position, 0), coordinate(position, 1),
                                    coordinate(position, 2)};
    const int last_shell = std::max({dims_[0], dims_[1], dims_[2]});
    Best best;
    for (int shell = 0; shell <= last_shell; ++shell) {
      // Whatever lies in this shell is at least (shell - 1) whole cells away.
      const double gap = std::max(0, shell - 1) * cell_;
      if (gap * gap > best.squared_distance) break;
      for_each_in_shell(center, shell, [&](std::size_t cell) {
        for (std::uint32_t m = first_[cell]; m < first_[cell + 1]; ++m) {
          const std::uint32_t n = members_[m];
          const double d2 = squared_norm(points_.position[n] - position);
          const bool closer =
              d2 < best.squared_distance || (d2 == best.squared_distance && n < best.point);
          if (closer && accept(n)) best = {d2, n};
        }
      });
    }
    return best;
  }

  template <class Visit>
  void for_each_in_shell(const std::array<int, 3>& center, int shell, Visit&& visit) const {
    const auto low = [&](std::size_t a) { return std::max(center[a] - shell, 0); };
    const auto high = [&](std::size_t a) { return std::min(center[a] + shell, dims_[a] - 1); };
    for (int k = low(2); k <= high(2); ++k) {
      for (int j = low(1); j <= high(1); ++j) {
        const bool whole_row = std::abs(k - center[2]) == shell || std::abs(j - center[1]) == shell;
        const int step = whole_row || shell == 0 ? 1 : 2 * shell;
        // A row inside the shell touches it only at its two ends.
        for (int i = center[0] - shell; i <= center[0] + shell; i += step) {
          if (i >= 0 && i < dims_[0]) visit(cell_index(i, j, k));
        }
      }
    }
  }

  const OrientedPoints& points_;
  Vec3 low_;
  double cell_{1};
  std::array<int, 3> dims_{1, 1, 1};
  std::vector<std::uint32_t> first_;    // cell -> first place in members_
  std::vector<std::uint32_t> members_;  // points by cell
};

}  // namespace

OrientedPoints sample_surface(const TriangleMesh& mesh, std::size_t count) {
  std::vector<Vec3> centers;
  centers.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    centers.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  }
  const std::vector<std::uint32_t> order = compact_order(centers, 1);
  double total = 0;
  for (const std::uint32_t t : order) total += norm(area_vector(mesh, mesh.triangles[t]));

  OrientedPoints samples;
  samples.position.reserve(count);
  samples.normal.reserve(count);
  // The plastic number's powers: x^3 = x + 1.
  constexpr double plastic = 1.32471795724474602596;
  const double step_u = 1 / plastic;
  const double step_v = 1 / (plastic * plastic);
  double area_before = 0;
  std::size_t k = 0;
  for (std::size_t o = 0; o < order.size(); ++o) {
    const auto& t = mesh.triangles[order[o]];
    const Vec3 vector = area_vector(mesh, t);
    const double area = norm(vector);
    const Vec3 normal = normalized(vector);
    const bool last = o + 1 == order.size();
    for (;
         k < count && (last || (static_cast<double>(k) + 0.5) / static_cast<double>(count) * total <
                                   area_before + area);
         ++k) {
      const double index = static_cast<double>(k) + 1;
      double u = index * step_u - std::floor(index * step_u);
      double v = index * step_v - std::floor(index * step_v);
      if (u + v > 1) {  // folding keeps the sequence's evenness, which a root would bend
        u = 1 - u;
        v = 1 - v;
      }
      const Vec3& a = mesh.vertices[t[0]];
      samples.position.push_back(a + u * (mesh.vertices[t[1]] - a) + v * (mesh.vertices[t[2]] - a));
      samples.normal.push_back(normal);
    }
    area_before += area;
  }
  return samples;
}

OrientedPoints spread_points(const TriangleMesh& mesh, const TriangleBvh& bvh, std::size_t count) {
  const OrientedPoints samples = sample_surface(mesh, samples_per_point * count);
  OrientedPoints points;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t sample = samples_per_point * n + samples_per_point / 2;
    points.position.push_back(samples.position[sample]);
    points.normal.push_back(samples.normal[sample]);
  }
  std::vector<Vec3> sum(count);
  std::vector<Vec3> normal_sum(count);
  std::vector<std::uint32_t> share(count);
  for (int round = 0; round < relaxation_rounds; ++round) {
    std::fill(sum.begin(), sum.end(), Vec3{});
    std::fill(normal_sum.begin(), normal_sum.end(), Vec3{});
    std::fill(share.begin(), share.end(), 0U);
    const NearestPoint nearest{points};
    for (std::size_t s = 0; s < samples.size(); ++s) {
      const std::uint32_t n = nearest.find(samples.position[s], samples.normal[s]);
      sum[n] += samples.position[s];
      normal_sum[n] += samples.normal[s];
      ++share[n];
    }
    for (std::size_t n = 0; n < count; ++n) {
      if (share[n] == 0) continue;
      const Vec3 step = sum[n] / share[n] - points.position[n];
      const double factor = round < over_relaxed_rounds ? over_relaxation : 1.0;
      points.position[n] = bvh.closest_point(points.position[n] + factor * step).point;
      points.normal[n] = normalized(normal_sum[n]);
    }
  }
  return points;
}

std::vector<double> tributary_areas(const OrientedPoints& points, const OrientedPoints& samples,
                                    double area) {
  std::vector<std::uint32_t> share(points.size(), 0);
  const NearestPoint nearest{points};
  for (std::size_t s = 0; s < samples.size(); ++s) {
    ++share[nearest.find(samples.position[s], samples.normal[s])];
  }
  std::vector<double> areas;
  areas.reserve(points.size());
  for (const std::uint32_t samples_here : share) {
    areas.push_back(area * samples_here / static_cast<double>(samples.size()));
  }
  return areas;
}

}  // namespace reckon
