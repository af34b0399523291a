// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/fields.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "reckon/core/vtk_xml.hpp"
#include "reckon/output/wall_surfaces.hpp"

namespace reckon {

void write_contact_lines(const std::filesystem::path& path, std::span<const ContactRecord> contacts,
                         double time) {
  std::vector<Vec3> ends;
  std::vector<Vec3> force;
  std::vector<double> magnitude;
  std::vector<double> deepest;
  std::vector<std::uint32_t> grain;
  std::vector<std::uint32_t> partner;
  std::vector<std::uint32_t> nodes;
  std::vector<std::uint8_t> with_wall;
  std::vector<std::uint8_t> bonded;
  for (const ContactRecord& contact : contacts) {
    ends.push_back(contact.from);
    ends.push_back(contact.to);
    force.push_back(contact.force);
    magnitude.push_back(norm(contact.force));
    deepest.push_back(contact.deepest);
    grain.push_back(contact.grain.get());
    partner.push_back(contact.partner);
    nodes.push_back(contact.touching);
    with_wall.push_back(contact.with_wall ? 1 : 0);
    bonded.push_back(contact.bonded ? 1 : 0);
  }
  VtkPolyData data;
  data.points = vtk_array("Points", ends);
  data.lines = consecutive_cells(contacts.size(), 2);
  data.cell_data = {vtk_array("force", force),         vtk_array("force_magnitude", magnitude),
                    vtk_array("grain", grain),         vtk_array("partner", partner),
                    vtk_array("with_wall", with_wall), vtk_array("deepest", deepest),
                    vtk_array("nodes", nodes),         vtk_array("bonded", bonded)};
  const std::vector<double> times{time};
  data.field_data = {vtk_array("TimeValue", times)};
  write_vtp(path, data);
}

std::optional<MembraneAtStep> membrane_now(const Simulation& simulation) {
  const Membrane* membrane = simulation.membrane();
  if (membrane == nullptr) return std::nullopt;
  MembraneAtStep now;
  for (std::uint32_t n = 0; n < membrane->mesh().size(); ++n) {
    const MembraneNode& node = membrane->nodes()[n];
    now.places.push_back(node.position);
    now.displacements.push_back(node.position - membrane->mesh().places()[n]);
    now.velocities.push_back(node.velocity);
    const auto around = membrane->mesh().neighbors(n);
    for (std::size_t corner = 0; corner < 2 && around[1] != MembraneMesh::none; ++corner) {
      auto& points = now.triangles.connectivity;
      points.insert(points.end(), {n, around[corner], around[corner + 1]});
      now.triangles.offsets.push_back(static_cast<std::int64_t>(points.size()));
    }
  }
  now.contact_forces.resize(now.places.size());
  for (const MembraneTouch& touch : membrane->touches()) {
    now.contact_forces[touch.spring.node] += touch.force;
  }
  return now;
}

void write_membrane(const std::filesystem::path& path, const MembraneAtStep& membrane,
                    double time) {
  VtkPolyData data;
  data.points = vtk_array("Points", membrane.places);
  data.polygons = membrane.triangles;
  data.point_data = {vtk_array("displacement", membrane.displacements),
                     vtk_array("velocity", membrane.velocities),
                     vtk_array("contact_force", membrane.contact_forces)};
  const std::vector<double> times{time};
  data.field_data = {vtk_array("TimeValue", times)};
  write_vtp(path, data);
}

void write_walls(const std::filesystem::path& path, const FieldsAtStep& fields,
                 std::span<const ShapeSummary> shapes, std::span<const Wall> walls,
                 std::optional<WallId> mould) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Extent extent{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  for (const GrainState& grain : fields.grains) {
    const double radius = shapes[grain.shape.get()].outline.bounding_radius;
    for (int axis = 0; axis < 3; ++axis) {
      extent.low[axis] = std::min(extent.low[axis], grain.position[axis] - radius);
      extent.high[axis] = std::max(extent.high[axis], grain.position[axis] + radius);
    }
  }
  WallPolygons drawn;
  if (!fields.grains.empty()) {
    const bool replaced = mould && fields.membrane;
    drawn = wall_polygons(walls, fields.wall_displacement, extent,
                          replaced ? std::optional{mould->get()} : std::nullopt);
  }
  std::vector<Vec3> force_on(walls.size());
  for (const ContactRecord& contact : fields.contacts) {
    if (contact.with_wall && contact.partner < walls.size()) {  // else it is the membrane
      force_on[contact.partner] -= contact.force;
    }
  }
  std::vector<Vec3> force;
  std::vector<Vec3> displacement;
  for (const std::uint32_t wall : drawn.wall) {
    force.push_back(force_on[wall]);
    displacement.push_back(fields.wall_displacement[wall]);
  }
  VtkPolyData data;
  data.points = vtk_array("Points", drawn.corners);
  data.polygons = drawn.polygons;
  data.cell_data = {vtk_array("wall", drawn.wall), vtk_array("displacement", displacement),
                    vtk_array("force", force)};
  const std::vector<double> times{fields.time};
  data.field_data = {vtk_array("TimeValue", times)};
  write_vtp(path, data);
}

void write_cell(const std::filesystem::path& path, const PeriodicCell& cell, double time) {
  std::vector<Vec3> corners;
  VtkCells lines;
  for (std::int64_t corner = 0; corner < 8; ++corner) {  // bit by bit along a, b and c
    const auto side = [&](int axis) { return (corner >> axis & 1) != 0 ? 0.5 : -0.5; };
    corners.push_back(cell.center() + cell.edges() * Vec3{side(0), side(1), side(2)});
    for (int axis = 0; axis < 3; ++axis) {
      if (side(axis) > 0) continue;
      lines.connectivity.insert(lines.connectivity.end(), {corner, corner + (1 << axis)});
      lines.offsets.push_back(static_cast<std::int64_t>(lines.connectivity.size()));
    }
  }
  VtkPolyData data;
  data.points = vtk_array("Points", corners);
  data.lines = lines;
  const std::vector<double> times{time};
  data.field_data = {vtk_array("TimeValue", times)};
  write_vtp(path, data);
}

}  // namespace reckon
