// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/io/fields.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>

#include "reckon/avatar/surface_extraction.hpp"
#include "reckon/core/vtk_xml.hpp"
#include "reckon/io/wall_surfaces.hpp"
#include "reckon/math/rotation.hpp"

namespace reckon {

void put_into(const PeriodicCell& cell, std::span<GrainState> grains) {
  for (GrainState& grain : grains) {
    const Vec3 edges = cell.nearest_image(grain.position - cell.center());
    grain.position -= cell.shift_of(edges);
    grain.velocity -= cell.velocity_of(edges);
  }
}

namespace {

/// How many partners each grain touches, and the sum of their forces.
struct TouchingOfGrains {
  std::vector<std::uint32_t> partners;
  std::vector<Vec3> force;  ///< [N]
};
TouchingOfGrains touching_of(const FieldsAtStep& fields) {
  std::vector<std::size_t> row_of_id;
  for (std::size_t row = 0; row < fields.grains.size(); ++row) {
    const std::uint32_t id = fields.grains[row].id.get();
    row_of_id.resize(std::max<std::size_t>(row_of_id.size(), id + 1U));
    row_of_id[id] = row;
  }
  TouchingOfGrains touching{std::vector<std::uint32_t>(fields.grains.size(), 0),
                            std::vector<Vec3>(fields.grains.size())};
  for (const ContactRecord& contact : fields.contacts) {
    const std::size_t row = row_of_id[contact.grain.get()];
    ++touching.partners[row];
    touching.force[row] += contact.force;
    if (contact.with_wall) continue;
    const std::size_t partner = row_of_id[contact.partner];
    ++touching.partners[partner];
    touching.force[partner] -= contact.force;
  }
  return touching;
}

double equivalent_radius_of(const ShapeOutline& form) {
  return std::cbrt(0.75 / std::numbers::pi * form.mass.volume);
}

Vec3 spin_of(const GrainState& grain) {
  return rotation_matrix(grain.orientation) * grain.angular_velocity_body;
}

}  // namespace

void write_grain_points(const std::filesystem::path& path, const FieldsAtStep& fields,
                        std::span<const ShapeSummary> shapes, double density) {
  std::vector<std::uint32_t> id;
  std::vector<std::uint32_t> shape;
  std::vector<std::uint8_t> prescribed;
  std::vector<double> radius;
  std::vector<double> equivalent_radius;
  std::vector<double> mass;
  std::vector<double> speed;
  std::vector<Vec3> position;
  std::vector<Quaternion> orientation;
  std::vector<Vec3> velocity;
  std::vector<Vec3> angular_velocity;
  for (const GrainState& grain : fields.grains) {
    const ShapeOutline& form = shapes[grain.shape.get()].outline;
    id.push_back(grain.id.get());
    shape.push_back(grain.shape.get());
    prescribed.push_back(grain.prescribed ? 1 : 0);
    radius.push_back(form.bounding_radius);
    equivalent_radius.push_back(equivalent_radius_of(form));
    mass.push_back(density * form.mass.volume);
    speed.push_back(norm(grain.velocity));
    position.push_back(grain.position);
    orientation.push_back(grain.orientation);
    velocity.push_back(grain.velocity);
    angular_velocity.push_back(spin_of(grain));
  }
  const TouchingOfGrains touching = touching_of(fields);
  VtkPolyData data;
  data.points = vtk_array("Points", position);
  data.vertices = consecutive_cells(id.size(), 1);
  data.point_data = {vtk_array("id", id),
                     vtk_array("shape", shape),
                     vtk_array("radius", radius),
                     vtk_array("equivalent_radius", equivalent_radius),
                     vtk_array("mass", mass),
                     vtk_array("orientation", orientation),
                     vtk_array("velocity", velocity),
                     vtk_array("angular_velocity", angular_velocity),
                     vtk_array("speed", speed),
                     vtk_array("prescribed", prescribed),
                     vtk_array("contacts", touching.partners),
                     vtk_array("contact_force", touching.force)};
  if (!fields.ranks.empty()) data.point_data.push_back(vtk_array("rank", fields.ranks));
  const std::vector<double> time{fields.time};
  data.field_data = {vtk_array("TimeValue", time),
                     vtk_array("wall_displacement", fields.wall_displacement)};
  write_vtp(path, data);
}

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

namespace {

/// Columns of floats with a row for each point of a surface. Pictures do not need doubles, and
/// these files are the largest of a run.
struct PointColumns {
  std::vector<float> place;
  std::vector<float> velocity;
  std::vector<float> spin;
  std::vector<float> force;
  std::vector<float> mass;
  std::vector<float> equivalent_radius;
  std::vector<std::uint32_t> partners;
  std::vector<std::uint32_t> rank;

  static void append(std::vector<float>& to, const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) to.push_back(static_cast<float>(v[axis]));
  }
  static void append(std::vector<float>& to, const Vec3& v, std::size_t times) {
    for (std::size_t n = 0; n < times; ++n) append(to, v);
  }
};

}  // namespace

void write_grain_surfaces(const std::filesystem::path& path, const FieldsAtStep& fields,
                          std::span<const ShapeSummary> shapes, double density,
                          std::span<const TriangleMesh> surfaces) {
  const TouchingOfGrains touching = touching_of(fields);
  PointColumns points;
  std::vector<std::uint32_t> id;
  std::vector<std::uint32_t> shape;
  std::vector<float> speed;
  VtkPolyData data;
  for (std::size_t row = 0; row < fields.grains.size(); ++row) {
    const GrainState& grain = fields.grains[row];
    const TriangleMesh& surface = surfaces[grain.shape.get()];
    const auto first = static_cast<std::int64_t>(points.place.size() / 3);
    const Mat3 rotation = rotation_matrix(grain.orientation);
    for (const Vec3& vertex : surface.vertices) {
      PointColumns::append(points.place, grain.position + rotation * vertex);
    }
    const std::size_t vertices = surface.vertices.size();
    const ShapeOutline& form = shapes[grain.shape.get()].outline;
    PointColumns::append(points.velocity, grain.velocity, vertices);
    PointColumns::append(points.spin, spin_of(grain), vertices);
    PointColumns::append(points.force, touching.force[row], vertices);
    points.mass.insert(points.mass.end(), vertices, static_cast<float>(density * form.mass.volume));
    points.equivalent_radius.insert(points.equivalent_radius.end(), vertices,
                                    static_cast<float>(equivalent_radius_of(form)));
    points.partners.insert(points.partners.end(), vertices, touching.partners[row]);
    if (!fields.ranks.empty()) {
      points.rank.insert(points.rank.end(), vertices, fields.ranks[row]);
    }
    for (const TriangleMesh::Triangle& triangle : surface.triangles) {
      for (const std::uint32_t corner : triangle) {
        data.polygons.connectivity.push_back(first + corner);
      }
      data.polygons.offsets.push_back(static_cast<std::int64_t>(data.polygons.connectivity.size()));
    }
    const std::size_t triangles = surface.triangles.size();
    id.insert(id.end(), triangles, grain.id.get());
    shape.insert(shape.end(), triangles, grain.shape.get());
    speed.insert(speed.end(), triangles, static_cast<float>(norm(grain.velocity)));
  }
  data.points = vtk_array("Points", points.place, 3);
  data.cell_data = {vtk_array("id", id), vtk_array("shape", shape), vtk_array("speed", speed)};
  data.point_data = {vtk_array("velocity", points.velocity, 3),
                     vtk_array("angular_velocity", points.spin, 3), vtk_array("mass", points.mass),
                     vtk_array("equivalent_radius", points.equivalent_radius)};
  if (fields.has_contacts) {
    data.point_data.push_back(vtk_array("contacts", points.partners));
    data.point_data.push_back(vtk_array("contact_force", points.force, 3));
  }
  if (!fields.ranks.empty()) data.point_data.push_back(vtk_array("rank", points.rank));
  const std::vector<double> times{fields.time};
  data.field_data = {vtk_array("TimeValue", times)};
  write_vtp(path, data);
}

std::vector<TriangleMesh> surface_meshes(std::span<const GrainState> grains,
                                         const ShapeStore::Read& read) {
  std::vector<TriangleMesh> meshes;
  for (const GrainState& grain : grains) {
    meshes.resize(std::max<std::size_t>(meshes.size(), grain.shape.get() + 1U));
    TriangleMesh& mesh = meshes[grain.shape.get()];
    if (mesh.triangles.empty()) mesh = extract_surface(read(grain.shape).level_set);
  }
  return meshes;
}

}  // namespace reckon
