// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scan/gray_gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace reckon {
namespace {

constexpr double line_step = 0.25;  // [voxels]
constexpr int line_half_steps = 14;

/// Trilinear interpolation between voxel centres; voxels outside count as the nearest inside, so a
/// part of a volume must cover the requested range.
double value_at(const GrayVolume& gray, const Vec3& world) {
  std::array<std::int32_t, 3> cell{};
  std::array<double, 3> place{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double g = std::clamp(world[axis] / gray.voxel - 0.5, static_cast<double>(gray.low[a]),
                                static_cast<double>(gray.low[a] + gray.dims[a] - 1));
    cell[a] = std::min(static_cast<std::int32_t>(g), gray.low[a] + std::max(gray.dims[a] - 2, 0));
    place[a] = g - cell[a];
  }
  double value = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const std::array<int, 3> step{corner & 1, corner >> 1 & 1, corner >> 2};
    double weight = 1;
    std::array<std::int32_t, 3> at = cell;
    for (std::size_t a = 0; a < 3; ++a) {
      weight *= step[a] == 1 ? place[a] : 1 - place[a];
      at[a] = std::min(cell[a] + step[a], gray.low[a] + gray.dims[a] - 1);
    }
    value += weight * gray.values[gray.index(at[0], at[1], at[2])];
  }
  return value;
}

/// The void share summed up along a line through `center` [voxels].
double void_along_line(const GrayVolume& gray, const GrayLevels& levels, const Vec3& center,
                       const Vec3& direction) {
  double sum = 0;
  for (int n = -line_half_steps; n <= line_half_steps; ++n) {
    const double t = line_step * n;
    sum += line_step * (1 - levels.share(value_at(gray, center + t * gray.voxel * direction)));
  }
  return sum;
}

/// Places of a grid within a radius, all in half voxels.
template <class Visit>
void for_each_in_disk(int radius, Visit&& visit) {
  for (int u = -radius; u <= radius; ++u) {
    for (int v = -radius; v <= radius; ++v) {
      if (u * u + v * v <= radius * radius) visit(u, v);
    }
  }
}

/// Numbers on a grid about the middle of a gap, across its lines.
class Across {
 public:
  explicit Across(int radius) : radius_{radius}, values_(side() * side(), 0.0) {}

  [[nodiscard]] double& at(int u, int v) { return values_[place(u, v)]; }
  [[nodiscard]] double at(int u, int v) const { return values_[place(u, v)]; }

 private:
  [[nodiscard]] std::size_t side() const { return 2 * static_cast<std::size_t>(radius_) + 1; }
  [[nodiscard]] std::size_t place(int u, int v) const {
    return static_cast<std::size_t>(u + radius_) * side() + static_cast<std::size_t>(v + radius_);
  }
  int radius_;
  std::vector<double> values_;
};

/// By least squares: w(x, y) = height + slope . (x, y) + the quadratic form of two principal
/// curvatures, all in voxels.
struct Paraboloid {
  double height{0};
  std::array<double, 2> slope{};      // along the principal directions
  std::array<double, 2> curvature{};  // likewise
};

Paraboloid fit_paraboloid(const Across& widths, int center_u, int center_v, int radius) {
  // On a symmetric disk 1 and r^2 alone are not orthogonal to each other.
  double n = 0;
  double r2 = 0;
  double r4 = 0;
  double x2 = 0;
  double difference2 = 0;
  double xy2 = 0;
  double w0 = 0;
  double wr2 = 0;
  double wx = 0;
  double wy = 0;
  double wd = 0;
  double wxy = 0;
  for_each_in_disk(radius, [&](int u, int v) {
    const double w = widths.at(center_u + u, center_v + v);
    const double x = 0.5 * u;
    const double y = 0.5 * v;
    const double r = x * x + y * y;
    const double d = x * x - y * y;
    n += 1;
    r2 += r;
    r4 += r * r;
    x2 += x * x;
    difference2 += d * d;
    xy2 += x * x * y * y;
    w0 += w;
    wr2 += w * r;
    wx += w * x;
    wy += w * y;
    wd += w * d;
    wxy += w * x * y;
  });
  const double determinant = n * r4 - r2 * r2;
  const double mean = 2 * (n * wr2 - r2 * w0) / determinant;  // curvature
  const double half = 2 * wd / difference2;                   // of (w_xx - w_yy)
  const double mixed = wxy / xy2;
  const double deviation = std::sqrt(half * half + mixed * mixed);
  const double slope_x = wx / x2;
  const double slope_y = wy / x2;
  // The first principal direction, at half the angle of (half, mixed).
  const double cosine_twice = deviation > 0 ? half / deviation : 1;
  const double cosine = std::sqrt(0.5 * (1 + cosine_twice));
  const double sine = std::copysign(std::sqrt(0.5 * (1 - cosine_twice)), mixed);
  return {(w0 * r4 - wr2 * r2) / determinant,
          {cosine * slope_x + sine * slope_y, cosine * slope_y - sine * slope_x},
          {mean + deviation, mean - deviation}};
}

}  // namespace

void EdgeProfile::add(const GrayVolume& gray, const GrayLevels& levels, const Vec3& point_world,
                      const Vec3& normal_world) {
  for (std::size_t n = 0; n < sum_.size(); ++n) {
    const double t = reach / half_steps * static_cast<double>(n) - reach;
    sum_[n] += levels.share(value_at(gray, point_world + t * gray.voxel * normal_world));
  }
  ++lines_;
}

void EdgeProfile::add(const EdgeProfile& other) {
  for (std::size_t n = 0; n < sum_.size(); ++n) sum_[n] += other.sum_[n];
  lines_ += other.lines_;
}

double EdgeProfile::spread() const {
  constexpr std::uint64_t fewest_lines = 200;
  if (lines_ < fewest_lines) return 1;
  double fall = 0;
  double first = 0;
  double second = 0;
  for (std::size_t n = 0; n + 1 < sum_.size(); ++n) {
    const double weight = sum_[n] - sum_[n + 1];
    const double t = reach / half_steps * (static_cast<double>(n) + 0.5) - reach;
    fall += weight;
    first += weight * t;
    second += weight * t * t;
  }
  const double variance = second / fall - (first / fall) * (first / fall);
  return fall > 0 && variance > 0 ? std::sqrt(variance) : 1;
}

double gray_gap(const GrayVolume& gray, const GrayLevels& levels, const NearPair& pair,
                double spread) {
  // All in half voxels.
  constexpr int search_radius = 10;
  constexpr int mean_radius = 2;
  constexpr int fit_radius = 4;
  constexpr double least_curvature = 0.02;  // [1 / voxel]; less is noise
  const Vec3 helper = std::abs(pair.normal_world.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 along_u = normalized(cross(helper, pair.normal_world));
  const Vec3 along_v = cross(pair.normal_world, along_u);
  Across widths{search_radius + fit_radius};
  for_each_in_disk(search_radius + fit_radius, [&](int u, int v) {
    const Vec3 center = pair.point_world + 0.5 * gray.voxel * (u * along_u + v * along_v);
    widths.at(u, v) = void_along_line(gray, levels, center, pair.normal_world);
  });
  int best_u = 0;
  int best_v = 0;
  double least = std::numeric_limits<double>::infinity();
  for_each_in_disk(search_radius, [&](int u, int v) {
    double sum = 0;
    for_each_in_disk(mean_radius, [&](int i, int j) { sum += widths.at(u + i, v + j); });
    if (!(sum < least)) return;
    least = sum;
    best_u = u;
    best_v = v;
  });
  const Paraboloid fit = fit_paraboloid(widths, best_u, best_v, fit_radius);
  double gap = fit.height;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double curvature = std::max(fit.curvature[axis], least_curvature);
    const double slope = std::abs(fit.slope[axis]);
    const double way = std::min(slope / curvature, 0.5 * fit_radius);  // to the lowest place
    gap -= way * (slope - 0.5 * curvature * way) + 0.5 * spread * spread * curvature;
  }
  return gap * gray.voxel;
}

}  // namespace reckon
