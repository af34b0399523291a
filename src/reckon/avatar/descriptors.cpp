// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/descriptors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "reckon/avatar/sieve_size.hpp"
#include "reckon/math/portable.hpp"

namespace reckon {
namespace {

constexpr std::size_t curvature_samples = 4096;
constexpr double curvature_reach = 0.1;  // of the equivalent diameter
constexpr std::size_t fewest_for_fit = 10;

/// The larger principal curvature of a graph z(u, v) at (0, 0), counted positive where the solid
/// below it is convex, from its first and second derivatives there.
double convex_curvature(double zu, double zv, double zuu, double zuv, double zvv) {
  const double w = std::sqrt(1 + zu * zu + zv * zv);
  const double mean =
      ((1 + zv * zv) * zuu - 2 * zu * zv * zuv + (1 + zu * zu) * zvv) / (2 * w * w * w);
  const double gauss = (zuu * zvv - zuv * zuv) / (w * w * w * w);
  return -(mean - std::sqrt(std::max(0.0, mean * mean - gauss)));
}

/// Fits z = c0 + c1 u + c2 v + (c3 u^2 + 2 c4 uv + c5 v^2) / 2 to points around `origin`, with z
/// along `normal` and lengths in units of `reach`. Empty when the points do not determine it.
std::optional<double> fitted_curvature(const std::vector<Vec3>& points, const Vec3& origin,
                                       const Vec3& normal, double reach) {
  const Vec3 helper = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 along_u = normalized(cross(helper, normal));
  const Vec3 along_v = cross(normal, along_u);
  Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> right = Eigen::Matrix<double, 6, 1>::Zero();
  for (const Vec3& p : points) {
    const Vec3 d = (p - origin) / reach;
    const double u = dot(d, along_u);
    const double v = dot(d, along_v);
    Eigen::Matrix<double, 6, 1> row;
    row << 1, u, v, u * u / 2, u * v, v * v / 2;
    matrix += row * row.transpose();
    right += dot(d, normal) * row;
  }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> solver{matrix};
  if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-12)) return std::nullopt;
  const Eigen::Matrix<double, 6, 1> c = solver.solve(right);
  return convex_curvature(c[1], c[2], c[3], c[4], c[5]) / reach;
}

/// Lists of points by cubic cell, to find all within one cell length of a place.
class CellLists {
 public:
  CellLists(const std::vector<Vec3>& points, double cell) : points_{points}, cell_{cell} {
    for (std::uint32_t n = 0; n < points.size(); ++n) keyed_.emplace_back(key(points[n]), n);
    std::sort(keyed_.begin(), keyed_.end());
  }

  template <class Visit>
  void for_each_near(const Vec3& place, Visit&& visit) const {
    const Key center = key(place);
    for (int k = -1; k <= 1; ++k) {
      for (int j = -1; j <= 1; ++j) {
        // Three neighbours along z lie behind each other in the sorted list.
        const Key low{center[0] + k, center[1] + j, center[2] - 1};
        const Key high{center[0] + k, center[1] + j, center[2] + 2};
        const auto by_key = [](const auto& entry, const Key& bound) { return entry.first < bound; };
        auto entry = std::lower_bound(keyed_.begin(), keyed_.end(), low, by_key);
        for (; entry != keyed_.end() && entry->first < high; ++entry) {
          if (squared_norm(points_[entry->second] - place) <= cell_ * cell_) visit(entry->second);
        }
      }
    }
  }

 private:
  using Key = std::array<std::int64_t, 3>;
  [[nodiscard]] Key key(const Vec3& p) const {
    return {std::llround(p.x / cell_), std::llround(p.y / cell_), std::llround(p.z / cell_)};
  }

  const std::vector<Vec3>& points_;
  double cell_;
  std::vector<std::pair<Key, std::uint32_t>> keyed_;
};

}  // namespace

double inscribed_radius(const TriangleBvh& bvh, const LevelSetView& grid) {
  const auto lowest = std::min_element(grid.values.begin(), grid.values.end());
  const auto index = static_cast<std::int64_t>(lowest - grid.values.begin());
  const auto i = static_cast<std::int32_t>(index % grid.dims[0]);
  const auto j = static_cast<std::int32_t>(index / grid.dims[0] % grid.dims[1]);
  const auto k = static_cast<std::int32_t>(index / grid.dims[0] / grid.dims[1]);
  Vec3 best = grid.origin_body + grid.spacing * Vec3{static_cast<double>(i), static_cast<double>(j),
                                                     static_cast<double>(k)};
  double deepest = -bvh.signed_distance(best);
  // A few points of the surface obstruct nearly all places, so they are tested first.
  std::vector<Vec3> in_the_way;
  const auto consider = [&](const Vec3& p) {
    const double reach = std::max(deepest, 0.0);
    const bool refused = std::any_of(in_the_way.rbegin(), in_the_way.rend(), [&](const Vec3& q) {
      return squared_norm(q - p) <= reach * reach;
    });
    if (refused) return false;
    if (const auto closest = bvh.closest_point_within(p, reach)) {
      in_the_way.push_back(closest->point);
      return false;
    }
    const double depth = -bvh.signed_distance(p);
    if (!(depth > deepest)) return false;
    best = p;
    deepest = depth;
    return true;
  };
  // The depth has ridges, on which few directions lead uphill; 26 find them.
  double step = grid.spacing;
  const double finest = 1e-4 * std::max(deepest, 0.0);
  while (step > finest && finest > 0) {
    const Vec3 center = best;
    bool improved = false;
    for (const double x : {-step, 0.0, step}) {
      for (const double y : {-step, 0.0, step}) {
        for (const double z : {-step, 0.0, step}) improved |= consider(center + Vec3{x, y, z});
      }
    }
    if (!improved) step /= 2;
  }
  return std::max(deepest, 0.0);
}

double corner_weight(double radius_over_inscribed) {
  constexpr double full = 0.75;
  constexpr double none = 0.95;
  return std::clamp((none - radius_over_inscribed) / (none - full), 0.0, 1.0);
}

double wadell_roundness(const OrientedPoints& samples, double inscribed, double reach) {
  const CellLists lists{samples.position, reach};
  double ratio_sum = 0;  // of radii over the inscribed one
  double weight_sum = 0;
  std::vector<Vec3> around;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    around.clear();
    Vec3 normal;
    lists.for_each_near(samples.position[s], [&](std::uint32_t n) {
      if (dot(samples.normal[n], samples.normal[s]) < -0.5) return;  // a thin plate's other side
      around.push_back(samples.position[n]);
      normal += samples.normal[n];
    });
    if (around.size() < fewest_for_fit) continue;
    const auto curvature = fitted_curvature(around, samples.position[s], normalized(normal), reach);
    if (!curvature || !(*curvature * inscribed > 1)) continue;
    const double ratio = 1 / (*curvature * inscribed);
    const double weight = corner_weight(ratio);
    ratio_sum += weight * ratio;
    weight_sum += weight;
  }
  return weight_sum == 0 ? 1.0 : ratio_sum / weight_sum;
}

ShapeDescriptors describe_shape(const TriangleMesh& body_mesh, const TriangleBvh& bvh,
                                const SolidProperties& solid, const LevelSetView& grid) {
  ShapeDescriptors d;
  const Vec3 extent = bvh.bounds().high - bvh.bounds().low;
  std::array<double, 3> lengths{extent.x, extent.y, extent.z};
  std::sort(lengths.begin(), lengths.end(), std::greater{});
  d.length = lengths[0];
  d.width = lengths[1];
  d.thickness = lengths[2];
  d.surface_area = solid.surface_area;
  d.equivalent_diameter = portable::cbrt(6 * solid.volume / std::numbers::pi);
  d.sieve_size = sieve_size(body_mesh.vertices);
  d.elongation = d.width / d.length;
  d.flatness = d.thickness / d.width;
  d.sphericity = std::numbers::pi * d.equivalent_diameter * d.equivalent_diameter / d.surface_area;
  d.convexity = std::min(1.0, solid.volume / convex_hull_volume(body_mesh.vertices));
  const std::vector<std::uint32_t> order = bvh.tree_order();
  d.roundness =
      wadell_roundness(sample_surface({body_mesh, order}, curvature_samples),
                       inscribed_radius(bvh, grid), curvature_reach * d.equivalent_diameter);
  return d;
}

}  // namespace reckon
