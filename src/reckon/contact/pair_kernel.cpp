// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/contact/pair_kernel.hpp"

#include "reckon/contact/relative_pose.hpp"
#include "reckon/contact/sphere_contact.hpp"

namespace reckon {

void find_touches(const GrainFrame& master, const GrainFrame& slave, std::vector<Touch>& touches) {
  const ShapeView& shape = *master.shape;
  const ShapeView& other = *slave.shape;
  if (are_spheres(master, slave)) {
    touch_spheres(master, slave, touches);
    return;
  }
  const LevelSetView grid = other.level_set;  // a copy: the compiler may keep it in registers
  if (!spheres_meet(master.position - slave.position,
                    shape.bounding_radius + other.bounding_radius)) {
    return;
  }
  const RelativePose at = relative_pose(master, slave);
  const double radius_squared = other.bounding_radius * other.bounding_radius;
  for (std::size_t n = 0; n < shape.nodes.size(); ++n) {
    const Vec3 node_body = shape.nodes.position(n);
    const Vec3 point = at.turn * node_body + at.shift;
    if (!(squared_norm(point) < radius_squared)) continue;
    const auto where = grid.locate(point);
    if (!where.inside) continue;
    const CellPolynomial cell = grid.polynomial(where.i, where.j, where.k);
    const double phi = cell.value(where.x, where.y, where.z);
    if (!(phi < 0)) continue;
    const Vec3 gradient_body = grid.inverse_spacing * cell.gradient(where.x, where.y, where.z);
    touches.push_back({static_cast<NodeIndex>(n), phi, slave.rotation * gradient_body,
                       master.rotation * node_body, shape.nodes.area[n]});
  }
}

}  // namespace reckon
