// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/analysis/delaunay.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "reckon/avatar/predicates.hpp"
#include "reckon/neighbor/space_order.hpp"

namespace reckon {
namespace {

constexpr std::uint32_t nobody = 0xFFFFFFFF;

/// A tetrahedron and who lies behind the face opposite each corner.
struct Cell {
  Tetrahedron corner{};
  std::array<std::uint32_t, 4> behind{nobody, nobody, nobody, nobody};
  bool alive{true};
};

class Triangulation {
 public:
  /// Four corners far outside hold everything; they are the last points.
  explicit Triangulation(std::span<const Vec3> points) : points_{points.begin(), points.end()} {
    Vec3 low = points_.front();
    Vec3 high = low;
    for (const Vec3& p : points_) {
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
    }
    const Vec3 centre = 0.5 * (low + high);
    const double far = 1e4 * std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
    const auto first = static_cast<std::uint32_t>(points_.size());
    for (const Vec3& way : {Vec3{-1, -1, -1}, Vec3{3, -1, -1}, Vec3{-1, 3, -1}, Vec3{-1, -1, 3}}) {
      points_.push_back(centre + far * way);
    }
    cells_.emplace_back().corner = {first, first + 1, first + 2, first + 3};
  }

  void insert(std::uint32_t point) {
    const std::uint32_t home = find(points_[point]);
    for (const std::uint32_t corner : cells_[home].corner) {
      if (points_[corner] == points_[point]) return;
    }
    dig(home, points_[point]);
    fill(point);
  }

  [[nodiscard]] std::vector<Tetrahedron> inner_cells(std::size_t inner_points) const {
    std::vector<Tetrahedron> found;
    for (const Cell& cell : cells_) {
      const auto is_inner = [&](std::uint32_t corner) { return corner < inner_points; };
      if (cell.alive && std::all_of(cell.corner.begin(), cell.corner.end(), is_inner)) {
        found.push_back(cell.corner);
      }
    }
    return found;
  }

 private:
  /// Whether the place is on the inner side of a cell's face: 1, on it: 0, behind it: -1.
  [[nodiscard]] int side(const Cell& cell, std::size_t face, const Vec3& place) const {
    std::array<Vec3, 4> corners;
    for (std::size_t n = 0; n < 4; ++n) corners[n] = points_[cell.corner[n]];
    corners[face] = place;
    return orientation(corners[0], corners[1], corners[2], corners[3]);
  }

  /// Walks from the newest cell towards the place; if rounding leads in circles, tests all cells.
  [[nodiscard]] std::uint32_t find(const Vec3& place) const {
    std::uint32_t at = static_cast<std::uint32_t>(cells_.size()) - 1;
    for (std::size_t steps = 0; steps < cells_.size(); ++steps) {
      const Cell& cell = cells_[at];
      std::size_t face = 0;
      while (face < 4 && side(cell, face, place) >= 0) ++face;
      if (face == 4) return at;
      if (cell.behind[face] == nobody) break;
      at = cell.behind[face];
    }
    for (std::uint32_t c = 0; c < cells_.size(); ++c) {
      std::size_t face = 0;
      while (face < 4 && side(cells_[c], face, place) >= 0) ++face;
      if (cells_[c].alive && face == 4) return c;
    }
    return at;
  }

  /// Whether the place is inside the sphere through the corners.
  [[nodiscard]] bool in_sphere(const Cell& cell, const Vec3& place) const {
    std::array<Vec3, 4> to;
    for (std::size_t n = 0; n < 4; ++n) to[n] = points_[cell.corner[n]] - place;
    const auto volume = [&](std::size_t a, std::size_t b, std::size_t c) {
      return dot(cross(to[a], to[b]), to[c]);
    };
    return squared_norm(to[0]) * volume(1, 2, 3) - squared_norm(to[1]) * volume(0, 2, 3) +
               squared_norm(to[2]) * volume(0, 1, 3) - squared_norm(to[3]) * volume(0, 1, 2) >
           0;
  }

  [[nodiscard]] bool in_hole(std::uint32_t cell) const {
    return std::find(hole_.begin(), hole_.end(), cell) != hole_.end();
  }

  /// Collects the cells around `home` whose spheres hold the place. Every face of their outside
  /// must be seen from it, which rounding may spoil: cells beyond a face that is not are taken as
  /// well.
  void dig(std::uint32_t home, const Vec3& place) {
    hole_ = {home};
    for (std::size_t n = 0; n < hole_.size(); ++n) {
      for (const std::uint32_t next : cells_[hole_[n]].behind) {
        if (next == nobody || in_hole(next)) continue;
        if (in_sphere(cells_[next], place)) hole_.push_back(next);
      }
    }
    for (std::size_t n = 0; n < hole_.size(); ++n) {
      for (std::size_t face = 0; face < 4; ++face) {
        const std::uint32_t next = cells_[hole_[n]].behind[face];
        if (next == nobody || in_hole(next)) continue;
        if (side(cells_[hole_[n]], face, place) > 0) continue;
        hole_.push_back(next);
        n = static_cast<std::size_t>(-1);  // test all again
        break;
      }
    }
  }

  /// Joins the point to every outer face of the hole.
  void fill(std::uint32_t point) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<std::uint32_t, std::size_t>> open;
    for (const std::uint32_t old : hole_) {
      for (std::size_t face = 0; face < 4; ++face) {
        const std::uint32_t outside = cells_[old].behind[face];
        if (outside != nobody && in_hole(outside)) continue;
        const auto made = static_cast<std::uint32_t>(cells_.size());
        Cell cell;
        cell.corner = cells_[old].corner;
        cell.corner[face] = point;
        cell.behind[face] = outside;
        cells_.push_back(cell);
        if (outside != nobody) {
          auto& behind = cells_[outside].behind;
          *std::find(behind.begin(), behind.end(), old) = made;
        }
        // Faces through the point meet in the edge opposite, of the two corners left.
        for (std::size_t own = 0; own < 4; ++own) {
          if (own == face) continue;
          std::array<std::uint32_t, 2> edge{};
          std::size_t found = 0;
          for (std::size_t n = 0; n < 4; ++n) {
            if (n != own && n != face) edge[found++] = cell.corner[n];
          }
          const auto [entry, first] = open.try_emplace(std::minmax(edge[0], edge[1]), made, own);
          if (first) continue;
          cells_[made].behind[own] = entry->second.first;
          cells_[entry->second.first].behind[entry->second.second] = made;
        }
      }
    }
    for (const std::uint32_t old : hole_) cells_[old].alive = false;
  }

  std::vector<Vec3> points_;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> hole_;
};

}  // namespace

std::vector<Tetrahedron> delaunay(std::span<const Vec3> points) {
  if (points.size() < 4) return {};
  Triangulation cells{points};
  // Neighbours in space follow each other, so that each walk is short.
  for (const std::uint32_t point : space_order(points)) cells.insert(point);
  return cells.inner_cells(points.size());
}

}  // namespace reckon
