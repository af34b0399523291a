// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "reckon/avatar/library_file.hpp"
#include "reckon/core/error.hpp"
#include "reckon/core/xxhash64.hpp"

namespace reckon {
namespace {

[[noreturn]] void refuse(const std::string& place, std::string problem, std::string reason = {}) {
  throw Error{{.place = place,
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = "Make the shape anew from its source."}};
}

void check_nodes(const SurfaceNodes& nodes, const std::string& place) {
  const std::size_t count = nodes.size();
  if (count == 0 || nodes.y.size() != count || nodes.z.size() != count ||
      nodes.area.size() != count) {
    refuse(place, "has no nodes, or node arrays of different lengths");
  }
  for (std::size_t n = 0; n < count; ++n) {
    if (!is_finite(nodes.position(n)) || !std::isfinite(nodes.area[n]) || nodes.area[n] < 0) {
      refuse(place, fmt::format("node {} has a position or area that is no good number", n));
    }
  }
}

template <class T>
void add(XxHash64& hash, const std::vector<T>& values) {
  hash.update(std::as_bytes(std::span{values}));
}

}  // namespace

void check_outline(const ShapeOutline& outline, std::uint64_t values, const std::string& place) {
  std::uint64_t count = 1;
  for (const std::int32_t dim : outline.dims) {
    if (dim < 2) refuse(place, "the grid has too few vertices", "each axis needs at least 2");
    // Three 31-bit numbers need not fit into 64 bits, so compare before multiplying.
    if (static_cast<std::uint64_t>(dim) > values / count) {
      refuse(place, "the grid's dims and its number of values disagree");
    }
    count *= static_cast<std::uint64_t>(dim);
  }
  if (count != values) refuse(place, "the grid's dims and its number of values disagree");
  // A band counts in single precision, where smaller steps vanish.
  constexpr double least_spacing = 1e-30;
  if (!(outline.spacing > least_spacing) || !std::isfinite(outline.spacing) ||
      !is_finite(outline.origin_body)) {
    refuse(place, "the grid's spacing or origin is no good number");
  }
  const auto& [volume, inertia] = outline.mass;
  for (const double positive :
       {volume, inertia.x, inertia.y, inertia.z, outline.bounding_radius, outline.lipschitz}) {
    if (!(positive > 0) || !std::isfinite(positive)) {
      refuse(place, "volume, inertia, bounding radius and Lipschitz constant must be positive",
             fmt::format("{} was found", positive));
    }
  }
  const double radius = outline.sphere_radius;
  const double equal = std::cbrt(0.75 / std::numbers::pi * volume);
  const bool fits =
      radius == 0 || (std::abs(radius - equal) < 0.1 * equal && radius <= outline.bounding_radius);
  if (!fits) {
    refuse(place, "the radius of the sphere that it should be does not fit",
           fmt::format("{} m at a volume of {} m^3", radius, volume));
  }
}

void check_shape(const Shape& shape, const std::string& place) {
  const std::vector<float>& values = shape.level_set.values;
  check_outline(outline_without_grid(shape), values.size(), place);
  if (!std::all_of(values.begin(), values.end(),
                   [](float value) { return std::isfinite(value); })) {
    refuse(place, "the grid holds a value that is not finite");
  }
  check_nodes(shape.nodes, place);
}

std::uint64_t shape_digest(const Shape& shape) {
  XxHash64 hash;
  add(hash, std::vector<std::int32_t>(shape.level_set.dims.begin(), shape.level_set.dims.end()));
  const Vec3& origin = shape.level_set.origin_body;
  const auto& [volume, inertia] = shape.mass;
  add(hash,
      std::vector<double>{shape.level_set.spacing, origin.x, origin.y, origin.z, volume, inertia.x,
                          inertia.y, inertia.z, shape.bounding_radius, shape.lipschitz});
  if (shape.sphere_radius != 0) add(hash, std::vector<double>{shape.sphere_radius});
  add(hash, shape.level_set.values);
  for (const auto* values : {&shape.nodes.x, &shape.nodes.y, &shape.nodes.z, &shape.nodes.area}) {
    add(hash, *values);
  }
  return hash.digest();
}

const Shape& find_shape(const ShapeLibrary& library, std::string_view name) {
  const auto found = std::find_if(library.begin(), library.end(),
                                  [&](const Shape& shape) { return shape.name == name; });
  if (found == library.end()) {
    throw Error{
        {.place = {},
         .problem = fmt::format("there is no shape named {}", name),
         .reason = fmt::format("the library holds {} shapes, the first is {}", library.size(),
                               library.empty() ? "missing" : library.front().name),
         .fix = "reckon grains info lists the names."}};
  }
  return *found;
}

}  // namespace reckon
