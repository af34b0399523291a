// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/fill_region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/random.hpp"
#include "reckon/math/portable.hpp"

namespace reckon {
namespace {

/// A region as a grid sees it: a box along three axes, of which some cells may be left out.
struct GridFrame {
  Vec3 corner;
  Vec3 axis_x{1, 0, 0};
  Vec3 axis_y{0, 1, 0};
  Vec3 axis_z{0, 0, 1};
  Vec3 size;
  double cylinder_radius{0};  // 0: a box; else cells must lie inside the cylinder in mid-box
};

GridFrame frame_of(const FillPlacement& fill) {
  GridFrame frame;
  if (const auto* box = std::get_if<BoxConfig>(&fill.region)) {
    frame.corner = box->low;
    frame.size = box->high - box->low;
    return frame;
  }
  const auto& cylinder = std::get<CylinderConfig>(fill.region);
  frame.axis_z = normalized(cylinder.axis);
  const Vec3 helper = std::abs(frame.axis_z.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  frame.axis_x = normalized(cross(helper, frame.axis_z));
  frame.axis_y = cross(frame.axis_z, frame.axis_x);
  frame.cylinder_radius = cylinder.radius;
  frame.size = {2 * cylinder.radius, 2 * cylinder.radius, fill.region_high - fill.region_low};
  frame.corner = cylinder.point + fill.region_low * frame.axis_z -
                 cylinder.radius * (frame.axis_x + frame.axis_y);
  return frame;
}

constexpr double spacing_in_radii = 2.2;
constexpr double jitter_in_radii = 0.1;  // (spacing - 2) / 2: spheres of neighbours never meet

/// Cells along one axis of a region: what is left free before the first, and how many there are.
struct CellRow {
  double margin{0};  // [m]
  std::int64_t count{0};

  [[nodiscard]] double center(std::int64_t n, double cell) const {
    return margin + cell * (static_cast<double>(n) + 0.5);
  }
};

CellRow centered(double length, double cell, double count) {
  return {0.5 * (length - count * cell), static_cast<std::int64_t>(count)};
}
double most_cells(double length, double cell) {
  constexpr double most = 1e9;  // more than any count of grains
  return std::clamp(std::floor(length / cell), 0.0, most);
}

/// The centres of the cells of one layer that lie in the region, row by row, at most `most`.
std::vector<Vec3> centers_in_layer(const GridFrame& frame, double cell, const CellRow& x,
                                   const CellRow& y, std::size_t most) {
  std::vector<Vec3> centers;
  const double room = frame.cylinder_radius - 0.5 * cell;
  if (frame.cylinder_radius > 0 && room < 0) return centers;
  for (std::int64_t j = 0; j < y.count && centers.size() < most; ++j) {
    for (std::int64_t i = 0; i < x.count && centers.size() < most; ++i) {
      const Vec3 center{x.center(i, cell), y.center(j, cell), 0};
      const double from_axis_x = center.x - 0.5 * frame.size.x;
      const double from_axis_y = center.y - 0.5 * frame.size.y;
      if (frame.cylinder_radius > 0 &&
          from_axis_x * from_axis_x + from_axis_y * from_axis_y > room * room) {
        continue;
      }
      centers.push_back(center);
    }
  }
  return centers;
}

/// A cylinder takes the grid with as many cells as its diameter holds where that has the `wanted`
/// cells in a layer. Else it takes, of the grids with a cell or an edge between cells on the axis,
/// the one with the most: each alone holds no fewer in a wider cylinder, so neither does the best.
std::vector<Vec3> best_centers(const GridFrame& frame, double cell, std::size_t wanted,
                               std::size_t most) {
  const double across_x = most_cells(frame.size.x, cell);
  const double across_y = most_cells(frame.size.y, cell);
  const CellRow x = centered(frame.size.x, cell, across_x);
  const CellRow y = centered(frame.size.y, cell, across_y);
  std::vector<Vec3> best = centers_in_layer(frame, cell, x, y, most);
  if (!(frame.cylinder_radius > 0) || across_x < 1 || across_y < 1) return best;
  const CellRow fewer_x = centered(frame.size.x, cell, across_x - 1);
  const CellRow fewer_y = centered(frame.size.y, cell, across_y - 1);
  for (const auto& [row_x, row_y] : {std::pair{fewer_x, fewer_y}, std::pair{x, fewer_y}}) {
    if (best.size() >= wanted) break;
    std::vector<Vec3> centers = centers_in_layer(frame, cell, row_x, row_y, most);
    if (centers.size() > best.size()) best = std::move(centers);
  }
  return best;
}

}  // namespace

Quaternion random_orientation(std::uint64_t seed, GrainId grain) {
  RandomStream stream{seed, RandomPurpose::orientation, grain.get()};
  const double share = stream.uniform();
  const auto first = portable::cos_sin_of_turns(stream.uniform());
  const auto second = portable::cos_sin_of_turns(stream.uniform());
  const double a = std::sqrt(1 - share);
  const double b = std::sqrt(share);
  return normalized(Quaternion{b * second.cos, a * first.sin, a * first.cos, b * second.sin});
}

std::vector<GrainState> fill_region(const FillPlacement& fill, std::span<const ShapeView> shapes,
                                    ShapeId first_shape, GrainId first_id, std::uint64_t seed) {
  double largest = 0;
  for (const ShapeView& shape : shapes) largest = std::max(largest, shape.bounding_radius);
  const GridFrame frame = frame_of(fill);
  const double cell = spacing_in_radii * largest;
  const auto layers = static_cast<std::uint64_t>(most_cells(frame.size.z, cell));
  const std::uint64_t wanted =
      (fill.count + std::max<std::uint64_t>(layers, 1) - 1) / std::max<std::uint64_t>(layers, 1);
  const std::vector<Vec3> columns = best_centers(frame, cell, wanted, fill.count);
  std::vector<GrainState> grains;
  for (std::uint64_t k = 0; k < layers && !columns.empty() && grains.size() < fill.count; ++k) {
    for (std::size_t c = 0; c < columns.size() && grains.size() < fill.count; ++c) {
      Vec3 place = columns[c];
      place.z = cell * (static_cast<double>(k) + 0.5);
      const GrainId id{first_id.get() + static_cast<std::uint32_t>(grains.size())};
      RandomStream jitter{seed, RandomPurpose::placement, id.get()};
      for (int axis = 0; axis < 3; ++axis) {
        place[axis] += jitter.uniform(-jitter_in_radii, jitter_in_radii) * largest;
      }
      RandomStream choice{seed, RandomPurpose::shape_choice, id.get()};
      const auto shape =
          static_cast<std::uint32_t>(choice.uniform() * static_cast<double>(shapes.size()));
      GrainState grain;
      grain.id = id;
      grain.shape = ShapeId{first_shape.get() + shape};
      grain.position =
          frame.corner + place.x * frame.axis_x + place.y * frame.axis_y + place.z * frame.axis_z;
      grain.orientation = random_orientation(seed, id);
      grain.velocity = fill.velocity;
      grains.push_back(grain);
    }
  }
  if (grains.size() < fill.count) {
    throw Error{
        {.place = "grains.region",
         .problem = fmt::format("{} grains do not fit, only {} do", fill.count, grains.size()),
         .reason = fmt::format("each needs a cell of {:.3g} m, {} times the largest "
                               "bounding radius",
                               cell, spacing_in_radii),
         .fix = "Make the region larger (higher, most often) or lower the count."}};
  }
  return grains;
}

}  // namespace reckon
