// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/placement_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/text/number_table.hpp"

namespace reckon {

std::vector<GrainState> read_placement(const std::filesystem::path& file, std::size_t shapes) {
  std::vector<GrainState> grains;
  const auto fail = [&](std::string problem, std::string reason) {
    throw Error{{.place = fmt::format("{}, grain {}", file.string(), grains.size() + 1),
                 .problem = std::move(problem),
                 .reason = std::move(reason),
                 .fix = "A line is `shape, x, y, z, qw, qx, qy, qz`."}};
  };
  for (const auto& [shape, x, y, z, qw, qx, qy, qz] : read_number_table<8>(file)) {
    if (!(shape >= 0 && shape < static_cast<double>(shapes) && shape == std::floor(shape))) {
      fail("there is no such shape",
           fmt::format("{} was found, the library has {} shapes counted from 0", shape, shapes));
    }
    const double length = std::sqrt(qw * qw + qx * qx + qy * qy + qz * qz);
    if (!(length > 0 && std::isfinite(length))) fail("the quaternion is no rotation", {});
    GrainState grain;
    grain.id = GrainId{static_cast<std::uint32_t>(grains.size())};
    grain.shape = ShapeId{static_cast<std::uint32_t>(shape)};
    grain.position = {x, y, z};
    grain.orientation = normalized(Quaternion{qw, qx, qy, qz});
    grains.push_back(grain);
  }
  return grains;
}

void write_placement(const std::filesystem::path& file, std::span<const GrainState> grains) {
  std::string text = "# shape,x_m,y_m,z_m,qw,qx,qy,qz\n";
  for (const GrainState& grain : grains) {
    const Vec3& p = grain.position;
    const Quaternion& q = grain.orientation;
    text += fmt::format("{},{},{},{},{},{},{},{}\n", grain.shape.get(), p.x, p.y, p.z, q.w, q.x,
                        q.y, q.z);
  }
  write_file(file, text);
}

}  // namespace reckon
