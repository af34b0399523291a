// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/simulation/placement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
  constexpr double spacing_in_radii = 2.2;
  constexpr double jitter_in_radii = 0.1;  // (spacing - 2) / 2: spheres of neighbours never meet
  const double cell = spacing_in_radii * largest;
  const auto cells = [&](double length) {
    return static_cast<std::int64_t>(std::floor(length / cell));
  };
  const std::int64_t nx = cells(frame.size.x);
  const std::int64_t ny = cells(frame.size.y);
  const std::int64_t nz = cells(frame.size.z);
  const Vec3 margin = 0.5 * Vec3{frame.size.x - static_cast<double>(nx) * cell,
                                 frame.size.y - static_cast<double>(ny) * cell, 0};
  std::vector<GrainState> grains;
  for (std::int64_t k = 0; k < nz && grains.size() < fill.count; ++k) {
    for (std::int64_t j = 0; j < ny && grains.size() < fill.count; ++j) {
      for (std::int64_t i = 0; i < nx && grains.size() < fill.count; ++i) {
        Vec3 place =
            margin + cell * Vec3{static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5,
                                 static_cast<double>(k) + 0.5};
        const double from_axis_x = place.x - 0.5 * frame.size.x;
        const double from_axis_y = place.y - 0.5 * frame.size.y;
        const double room = frame.cylinder_radius - 0.5 * cell;
        if (frame.cylinder_radius > 0 &&
            (room < 0 || from_axis_x * from_axis_x + from_axis_y * from_axis_y > room * room)) {
          continue;
        }
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
