// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/sieve_size.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "reckon/avatar/geodesic_sphere.hpp"
#include "reckon/math/portable.hpp"

namespace reckon {
namespace {

constexpr std::uint32_t directions = 8;  // geodesic frequency: 642 of them, 7 degrees apart
constexpr int square_turns = 45;         // of a square, over a quarter turn
constexpr int finest_turn = 5;           // halvings of that step
constexpr double first_tilt = 0.1;       // of the direction [rad]
constexpr double last_tilt = 2e-3;

/// The points that are farthest out in some direction: the square around them is that around all,
/// but for what lies between two directions.
std::vector<Vec3> farthest_points(std::span<const Vec3> points) {
  std::set<std::size_t> chosen;
  for (const Vec3& direction : geodesic_sphere(directions).vertices) {
    std::size_t best = 0;
    double reach = -std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < points.size(); ++n) {
      const double along = dot(points[n], direction);
      if (along <= reach) continue;
      reach = along;
      best = n;
    }
    chosen.insert(best);
  }
  std::vector<Vec3> farthest;
  farthest.reserve(chosen.size());
  for (const std::size_t n : chosen) farthest.push_back(points[n]);
  return farthest;
}

/// A projection along a direction.
class Shadow {
 public:
  Shadow(const std::vector<Vec3>& points, const Vec3& direction) {
    const Vec3 helper = std::abs(direction.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = normalized(cross(helper, direction));
    const Vec3 v = cross(direction, u);
    for (const Vec3& p : points) shadow_.push_back({dot(p, u), dot(p, v)});
  }

  /// The side of the least square around it.
  [[nodiscard]] double least_square() const {
    const double first_step = 0.25 / square_turns;
    double best_turn = 0;
    double best = std::numeric_limits<double>::infinity();
    const auto consider = [&](double turn) {
      const double side = square_at(turn);
      if (side >= best) return false;
      best = side;
      best_turn = turn;
      return true;
    };
    for (int n = 0; n < square_turns; ++n) (void)consider(n * first_step);
    double step = first_step;
    for (int halving = 0; halving < finest_turn; ++halving) {
      step /= 2;
      const double middle = best_turn;
      (void)consider(middle - step);
      (void)consider(middle + step);
    }
    return best;
  }

 private:
  /// The side of the square around it whose sides are turned by so much of a full turn.
  [[nodiscard]] double square_at(double turn) const {
    const auto [cos, sin] = portable::cos_sin_of_turns(turn);
    std::array<double, 2> low{shadow_[0][0] * cos + shadow_[0][1] * sin,
                              shadow_[0][1] * cos - shadow_[0][0] * sin};
    std::array<double, 2> high = low;
    for (const auto& [x, y] : shadow_) {
      const double along = x * cos + y * sin;
      const double across = y * cos - x * sin;
      low = {std::min(low[0], along), std::min(low[1], across)};
      high = {std::max(high[0], along), std::max(high[1], across)};
    }
    return std::max(high[0] - low[0], high[1] - low[1]);
  }

  std::vector<std::array<double, 2>> shadow_;
};

}  // namespace

double sieve_size(std::span<const Vec3> points) {
  if (points.empty()) return 0;
  const std::vector<Vec3> farthest = farthest_points(points);
  const auto side_along = [&](const Vec3& direction) {
    return Shadow{farthest, direction}.least_square();
  };
  Vec3 best{1, 0, 0};
  double least = side_along(best);
  const auto consider = [&](const Vec3& direction) {
    const double side = side_along(direction);
    if (side >= least) return false;
    least = side;
    best = direction;
    return true;
  };
  (void)consider({0, 1, 0});
  (void)consider({0, 0, 1});
  for (double tilt = first_tilt; tilt > last_tilt;) {
    const Vec3 middle = best;
    const Vec3 helper = std::abs(middle.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = normalized(cross(helper, middle));
    const Vec3 v = cross(middle, u);
    bool improved = false;
    for (const auto& [a, b] : {std::array{tilt, 0.0}, {-tilt, 0.0}, {0.0, tilt}, {0.0, -tilt}}) {
      improved |= consider(normalized(middle + a * u + b * v));
    }
    if (!improved) tilt /= 2;
  }
  return least;
}

}  // namespace reckon
