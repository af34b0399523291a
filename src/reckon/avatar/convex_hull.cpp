// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "reckon/avatar/descriptors.hpp"
#include "reckon/avatar/triangle_bvh.hpp"

namespace reckon {
namespace {

// With coordinates in [0, 2^20] a volume determinant stays below 3 * 2^61: exact in 64 bits.
constexpr double resolution = 1 << 20;
using Lattice = std::array<std::int64_t, 3>;
using Index = std::uint32_t;

/// Six times the volume of the tetrahedron (a, b, c, p); positive when p is on the outer side of
/// the counter-clockwise facet (a, b, c).
std::int64_t six_volumes(const Lattice& a, const Lattice& b, const Lattice& c, const Lattice& p) {
  const auto from_a = [&](const Lattice& q) {
    return Lattice{q[0] - a[0], q[1] - a[1], q[2] - a[2]};
  };
  const Lattice u = from_a(b);
  const Lattice v = from_a(c);
  const Lattice w = from_a(p);
  return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] +
         (u[0] * v[1] - u[1] * v[0]) * w[2];
}

struct Facet {
  std::array<Index, 3> corner{};
  std::array<Index, 3> neighbor{};  // across the side from corner s to corner s + 1
  std::vector<Index> outside;       // points outside this facet, each stored with one facet only
  bool alive{true};
};

class Quickhull {
 public:
  explicit Quickhull(std::vector<Lattice> points) : points_{std::move(points)} {}

  /// Six times the hull's volume; zero when all points lie in a plane.
  std::int64_t run() {
    if (!start()) return 0;
    for (Index f = 0; f < facets_.size(); ++f) {
      if (facets_[f].alive && !facets_[f].outside.empty()) add_farthest_point_of(f);
    }
    // The hull as tetrahedra from its first corner.
    std::int64_t volume = 0;
    const Lattice origin = points_[apex_];
    for (const Facet& facet : facets_) {
      if (facet.alive) volume -= height(facet, origin);
    }
    return volume;
  }

 private:
  [[nodiscard]] std::int64_t height(const Facet& f, const Lattice& p) const {
    return six_volumes(points_[f.corner[0]], points_[f.corner[1]], points_[f.corner[2]], p);
  }

  /// A first tetrahedron. False when there is none.
  bool start() {
    const auto farthest = [&](auto&& measure) {
      Index best = 0;
      for (Index n = 1; n < points_.size(); ++n) {
        if (measure(points_[n]) > measure(points_[best])) best = n;
      }
      return best;
    };
    if (points_.size() < 4) return false;
    const Index a = farthest([](const Lattice& p) { return -p[0]; });
    const auto cross_norm = [&](const Lattice& b, const Lattice& p) {
      const auto d = [&](const Lattice& q, std::size_t k) {
        return static_cast<double>(q[k] - points_[a][k]);
      };
      return squared_norm(cross(Vec3{d(b, 0), d(b, 1), d(b, 2)}, Vec3{d(p, 0), d(p, 1), d(p, 2)}));
    };
    const Index b = farthest([&](const Lattice& p) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        sum += std::pow(static_cast<double>(p[k] - points_[a][k]), 2);
      }
      return sum;
    });
    const Index c = farthest([&](const Lattice& p) { return cross_norm(points_[b], p); });
    const Index d = farthest([&](const Lattice& p) {
      return std::abs(six_volumes(points_[a], points_[b], points_[c], p));
    });
    const std::int64_t volume = six_volumes(points_[a], points_[b], points_[c], points_[d]);
    if (volume == 0) return false;
    apex_ = a;
    // d lies on the inner side of the first facet.
    const std::array<Index, 4> v = volume < 0 ? std::array{a, b, c, d} : std::array{a, c, b, d};
    facets_.push_back({{v[0], v[1], v[2]}, {1, 2, 3}, {}, true});
    facets_.push_back({{v[1], v[0], v[3]}, {0, 3, 2}, {}, true});
    facets_.push_back({{v[2], v[1], v[3]}, {0, 1, 3}, {}, true});
    facets_.push_back({{v[0], v[2], v[3]}, {0, 2, 1}, {}, true});
    std::vector<Index> all(points_.size());
    for (Index n = 0; n < all.size(); ++n) all[n] = n;
    distribute(all, 0);
    first_side_.resize(points_.size());
    return true;
  }

  /// Gives each point to the first facet from `from` on that it sees; a point that sees none lies
  /// inside and is forgotten.
  void distribute(const std::vector<Index>& points, Index from) {
    for (const Index n : points) {
      for (Index f = from; f < facets_.size(); ++f) {
        if (height(facets_[f], points_[n]) > 0) {
          facets_[f].outside.push_back(n);
          break;
        }
      }
    }
  }

  void add_farthest_point_of(Index seed) {
    const std::vector<Index>& candidates = facets_[seed].outside;
    const Index p = *std::max_element(candidates.begin(), candidates.end(), [&](Index a, Index b) {
      return height(facets_[seed], points_[a]) < height(facets_[seed], points_[b]);
    });
    // The facets with p on their outer side are connected; their border is the horizon.
    const auto first_new = static_cast<Index>(facets_.size());
    std::vector<Index> visible{seed};
    std::vector<Index> orphans;
    std::vector<Facet> cone;
    facets_[seed].alive = false;
    for (std::size_t k = 0; k < visible.size(); ++k) {
      const Facet& facet = facets_[visible[k]];
      orphans.insert(orphans.end(), facet.outside.begin(), facet.outside.end());
      for (std::size_t s = 0; s < 3; ++s) {
        const Index other = facet.neighbor[s];
        if (!facets_[other].alive) continue;
        if (height(facets_[other], points_[p]) > 0) {
          facets_[other].alive = false;
          visible.push_back(other);
        }
      }
    }
    for (const Index gone : visible) {
      const Facet& facet = facets_[gone];
      for (std::size_t s = 0; s < 3; ++s) {
        if (!facets_[facet.neighbor[s]].alive) continue;
        const Index from = facet.corner[s];
        const Index to = facet.corner[(s + 1) % 3];
        const auto self = static_cast<Index>(first_new + cone.size());
        cone.push_back({{from, to, p}, {facet.neighbor[s], 0, 0}, {}, true});
        first_side_[from] = self;
        for (std::size_t t = 0; t < 3; ++t) {
          Facet& beyond = facets_[facet.neighbor[s]];
          if (beyond.corner[t] == to) beyond.neighbor[t] = self;
        }
      }
      facets_[gone].outside = {};
    }
    for (Facet& facet : cone) {
      const Index after = first_side_[facet.corner[1]];
      facet.neighbor[1] = after;
      cone[after - first_new].neighbor[2] =
          static_cast<Index>(first_new + static_cast<Index>(&facet - cone.data()));
    }
    facets_.insert(facets_.end(), cone.begin(), cone.end());
    distribute(orphans, first_new);
  }

  std::vector<Lattice> points_;
  std::vector<Facet> facets_;
  std::vector<Index> first_side_;  // by horizon corner: the new facet whose side begins there
  Index apex_{0};
};

}  // namespace

double convex_hull_volume(std::span<const Vec3> points) {
  BoundingBox box;
  for (const Vec3& p : points) box.include(p);
  const Vec3 extent = box.high - box.low;
  const double longest = std::max({extent.x, extent.y, extent.z});
  if (points.empty() || !(longest > 0)) return 0;
  std::vector<Lattice> lattice;
  lattice.reserve(points.size());
  for (const Vec3& p : points) {
    const auto rounded = [&](int axis) {
      return std::llround((p[axis] - box.low[axis]) / longest * resolution);
    };
    lattice.push_back({rounded(0), rounded(1), rounded(2)});
  }
  std::sort(lattice.begin(), lattice.end());
  lattice.erase(std::unique(lattice.begin(), lattice.end()), lattice.end());
  const double unit = longest / resolution;
  return static_cast<double>(Quickhull{std::move(lattice)}.run()) / 6 * unit * unit * unit;
}

}  // namespace reckon
