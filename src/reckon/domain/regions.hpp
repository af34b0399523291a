// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "reckon/math/vec3.hpp"

namespace reckon {

/// A box that may reach to infinity. A point on a face between two boxes belongs to the upper one.
struct Region {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low{-infinity, -infinity, -infinity};  ///< inclusive [m]
  Vec3 high{infinity, infinity, infinity};    ///< exclusive [m]

  [[nodiscard]] bool contains(const Vec3& p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x < high.x && p.y < high.y &&
           p.z < high.z;
  }
  [[nodiscard]] bool empty() const { return !(low.x < high.x && low.y < high.y && low.z < high.z); }
  /// Squared distance from the box, zero inside [m^2]. Along axes where `period` is above zero
  /// space repeats itself, and the box counts between zero and that.
  [[nodiscard]] double squared_distance(const Vec3& p, const Vec3& period = {}) const;
  /// Whether some point of this box is within `reach` of some point of the other.
  [[nodiscard]] bool within(const Region& other, double reach, const Vec3& period = {}) const;
};

/// The smallest box around points, closed by a hair so that it contains them all. No points: empty.
[[nodiscard]] Region bounding_region(std::span<const Vec3> points);

/// Which of `regions` holds `p`, tried first at `guess`; none: `guess`. They cover all of space
/// when they come from a bisection.
[[nodiscard]] int region_holding(std::span<const Region> regions, const Vec3& p, int guess);

/// Equal blocks of a Cartesian grid (paper, section 2.2), each made of whole bins. Outer blocks
/// extend to infinity, so no grain can leave the domain (paper, section 3.4).
struct GridCut {
  std::array<int, 3> blocks{1, 1, 1};  ///< along x, y, z; their product is at most the ranks given
  std::array<int, 3> bins{1, 1, 1};    ///< bins of the whole domain along x, y, z
  Vec3 origin;                         ///< the domain's lowest corner [m]
  Vec3 bin_size;                       ///< each at least the reach it was cut for [m]

  [[nodiscard]] int block_count() const { return blocks[0] * blocks[1] * blocks[2]; }
  /// The first bin of block `block` along `axis`; block == blocks[axis] gives one past the last.
  [[nodiscard]] int first_bin(int axis, int block) const {
    const auto a = static_cast<std::size_t>(axis);
    return static_cast<int>(static_cast<long>(block) * bins[a] / blocks[a]);
  }
  /// The bin that holds a coordinate, those outside counted to the nearest.
  [[nodiscard]] int bin_of(int axis, double coordinate) const;
  [[nodiscard]] int block_of(int axis, int bin) const;
  [[nodiscard]] std::array<int, 3> block_place(int block) const;
  [[nodiscard]] int block_at(const std::array<int, 3>& place) const {
    return (place[2] * blocks[1] + place[1]) * blocks[0] + place[0];
  }
  [[nodiscard]] int owner_of(const Vec3& p) const;
};

/// Cuts `domain` into at most `ranks` blocks of at least one bin each. Ranks beyond the number of
/// blocks stay without grains. `reach` is the least bin size [m].
[[nodiscard]] GridCut cut_grid(const Region& domain, int ranks, double reach);

}  // namespace reckon
