// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "reckon/math/upper_triangular.hpp"
#include "reckon/math/vec3.hpp"

namespace reckon {

/// What of a periodic cell changes during a run.
struct CellState {
  /// The columns are the cell's edges a, b, c: a along x, b in the plane of x and y [m].
  UpperMat3 edges;
  UpperMat3 rates;                 ///< d(edges)/dt over the last step [m/s]
  UpperMat3 edges_at_stage_start;  ///< [m]
  Vec3 shear;                      ///< strains xy, xz, yz since the run began
  Vec3 shear_at_stage_start;
  double work{0};  ///< done on the grains by the contacts' stress as the cell moved [J]

  friend bool operator==(const CellState&, const CellState&) = default;
};

/// A cell of space that repeats itself along some of its edges.
///
/// Grains keep their unwrapped positions, which never jump. Periodicity is in the pairs: two grains
/// a and b meet through the image of b that is nearest to a,
///
///   d = x_a - (x_b + H n)        n = round(H^-1 (x_a - x_b)), whole numbers
///
/// where the columns of H are the edges; the image moves with v_b + dH/dt n. Here a is the grain
/// with the lower id. Every rank that has both grains computes the same n and d from the same bits,
/// so no image is stored or sent, and nothing changes when a grain crosses a border. In a cell at
/// least twice as wide as the reach of two grains, a pair meets through one image only.
class PeriodicCell {
 public:
  /// `periodic` by axis; edges that are not periodic do not matter, but must have a length.
  PeriodicCell(const Vec3& center, const std::array<bool, 3>& periodic, const UpperMat3& edges,
               const UpperMat3& rates)
      : center_{center},
        periodic_{periodic},
        edges_{edges},
        rates_{rates},
        inverse_{inverse(edges)} {}

  [[nodiscard]] const Vec3& center() const { return center_; }
  [[nodiscard]] bool is_periodic(int axis) const {
    return periodic_[static_cast<std::size_t>(axis)];
  }
  [[nodiscard]] bool is_closed() const { return periodic_[0] && periodic_[1] && periodic_[2]; }
  [[nodiscard]] const UpperMat3& edges() const { return edges_; }
  [[nodiscard]] const UpperMat3& rates() const { return rates_; }
  [[nodiscard]] double volume() const {
    return edges_.diagonal.x * edges_.diagonal.y * edges_.diagonal.z;
  }

  /// The velocity gradient L = dH/dt H^-1 [1/s].
  [[nodiscard]] UpperMat3 gradient() const { return rates_ * inverse_; }
  /// A point as multiples of the edges, from the centre.
  [[nodiscard]] Vec3 fractions(const Vec3& point) const { return inverse_ * (point - center_); }
  /// The velocity of the cell's own motion at a point [m/s].
  [[nodiscard]] Vec3 velocity_at(const Vec3& point) const { return rates_ * fractions(point); }

  /// How many edges take b to its image nearest to a; `apart` is x_a - x_b.
  [[nodiscard]] Vec3 nearest_image(const Vec3& apart) const {
    const Vec3 s = inverse_ * apart;
    return {periodic_[0] ? std::floor(s.x + 0.5) : 0, periodic_[1] ? std::floor(s.y + 0.5) : 0,
            periodic_[2] ? std::floor(s.z + 0.5) : 0};
  }
  [[nodiscard]] Vec3 shift_of(const Vec3& image) const { return edges_ * image; }
  [[nodiscard]] Vec3 velocity_of(const Vec3& image) const { return rates_ * image; }
  /// From b's nearest image to a [m].
  [[nodiscard]] Vec3 branch(const Vec3& a, const Vec3& b) const {
    const Vec3 image = nearest_image(a - b);
    return a - (b + shift_of(image));
  }

  /// The point's image in the cell around the centre [m].
  [[nodiscard]] Vec3 wrapped(const Vec3& point) const {
    return point - shift_of(nearest_image(point - center_));
  }
  /// Distances between opposite faces; zero along axes that are not periodic [m].
  [[nodiscard]] Vec3 widths() const;
  /// The least of them [m].
  [[nodiscard]] double least_width() const;
  /// Where a point lies between the faces, from 0 to widths(); along other axes, its coordinate.
  /// No axis is farther apart here than in space: a box with right angles that decompositions can
  /// cut. Points `reach` apart are at most reach * stretch() apart here [m].
  [[nodiscard]] Vec3 place(const Vec3& point) const;
  [[nodiscard]] double stretch() const;

  /// A step of `time_step` with new rates. Where edges lean by more than half an edge, others of
  /// the same lattice are taken. Returns the velocity gradient L over the step: a point that moves
  /// with the cell goes from x to x + time_step L (x - centre).
  UpperMat3 advance(const UpperMat3& rates, double time_step);

 private:
  void straighten();

  Vec3 center_;
  std::array<bool, 3> periodic_;
  UpperMat3 edges_;
  UpperMat3 rates_;
  UpperMat3 inverse_;
};

/// place() of all, or the points themselves without a cell.
[[nodiscard]] std::vector<Vec3> places_in(const PeriodicCell* cell, std::span<const Vec3> points);

}  // namespace reckon
