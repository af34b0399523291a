// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/pair_kernel.hpp"

#include "reckon/contact/placement.hpp"

namespace reckon {

void find_touches(const GrainFrame& master, const GrainFrame& slave, std::vector<Touch>& touches) {
  const ShapeView& shape = *master.shape;
  const ShapeView& other = *slave.shape;
  if (!spheres_meet(master.position - slave.position,
                    shape.bounding_radius + other.bounding_radius)) {
    return;
  }
  const Placement at = place(master, slave);
  const double radius_squared = other.bounding_radius * other.bounding_radius;
  for (std::size_t n = 0; n < shape.node_x.size(); ++n) {
    const Vec3 node_body{shape.node_x[n], shape.node_y[n], shape.node_z[n]};
    const Vec3 point = at.turn * node_body + at.shift;
    if (!(squared_norm(point) < radius_squared)) continue;
    const auto sample = other.level_set.sample(point);
    if (!sample.inside_grid || !(sample.phi < 0)) continue;
    touches.push_back({static_cast<NodeIndex>(n), sample.phi, slave.rotation * sample.gradient_body,
                       master.rotation * node_body, shape.node_area[n]});
  }
}

}  // namespace reckon
