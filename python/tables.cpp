// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "tables.hpp"

#include "arrays.hpp"
#include "reckon/math/rotation.hpp"

namespace reckon::python {
namespace {

/// What grains under way and saved ones share.
template <class Grains>
py::dict poses_of(const Grains& grains) {
  py::dict table;
  table["id"] = column<std::uint32_t>(grains, [](const auto& g) { return g.id.get(); });
  table["shape"] = column<std::uint32_t>(grains, [](const auto& g) { return g.shape.get(); });
  table["prescribed"] = column<bool>(grains, [](const auto& g) { return g.prescribed; });
  table["position"] = vectors(grains, [](const auto& g) { return g.position; });
  table["orientation"] = vectors(grains, [](const auto& g) { return g.orientation; });
  table["velocity"] = vectors(grains, [](const auto& g) { return g.velocity; });
  return table;
}

}  // namespace

py::dict table_of(const Measurement& m) {
  py::dict table;
  table["step"] = m.step;
  table["time"] = m.time;
  table["grains"] = m.grains;
  table["departed"] = m.departed;
  table["contacts"] = m.contacts;
  table["wall_contacts"] = m.wall_contacts;
  table["touching_nodes"] = m.touching_nodes;
  table["bonds"] = m.bonds;
  table["broken_in_tension"] = m.broken_bonds.in_tension;
  table["broken_in_shear"] = m.broken_bonds.in_shear;
  table["coordination"] = m.coordination;
  table["unbalanced_ratio"] = m.unbalanced_ratio;
  table["deepest_overlap"] = m.deepest_overlap;
  table["largest_speed"] = m.largest_speed;
  table["momentum"] = tuple_of(m.momentum);
  table["wall_force"] = rows_of(m.wall_force);
  py::dict energy;
  energy["translation"] = m.energy.translation;
  energy["rotation"] = m.energy.rotation;
  energy["gravity"] = m.energy.gravity;
  energy["elastic"] = m.energy.elastic;
  energy["friction"] = m.energy.friction;
  energy["dashpot"] = m.energy.dashpot;
  energy["fracture"] = m.energy.fracture;
  energy["damping"] = m.energy.damping;
  energy["body_work"] = m.energy.body_work;
  energy["wall_work"] = m.energy.wall_work;
  energy["departed"] = m.energy.departed;
  energy["total"] = m.energy.total();
  table["energy"] = energy;
  return table;
}

py::dict table_of(const std::vector<GrainState>& grains) {
  py::dict table = poses_of(grains);
  table["angular_velocity"] = vectors(grains, [](const GrainState& g) {
    return rotation_matrix(g.orientation) * g.angular_velocity_body;
  });
  return table;
}

py::dict table_of(const std::vector<SavedGrain>& grains) {
  py::dict table = poses_of(grains);
  table["angular_velocity"] = vectors(grains, [](const auto& g) { return g.angular_velocity; });
  table["radius"] = column<double>(grains, [](const auto& g) { return g.radius; });
  table["equivalent_radius"] =
      column<double>(grains, [](const auto& g) { return g.equivalent_radius; });
  table["mass"] = column<double>(grains, [](const auto& g) { return g.mass; });
  table["touching"] = column<std::uint32_t>(grains, [](const auto& g) { return g.touching; });
  table["cell_shift"] = vectors(grains, [](const auto& g) { return g.cell_shift; });
  return table;
}

py::dict table_of(const std::vector<ContactRecord>& contacts) {
  py::dict table;
  table["grain"] = column<std::uint32_t>(contacts, [](const auto& c) { return c.grain.get(); });
  table["partner"] = column<std::uint32_t>(contacts, [](const auto& c) { return c.partner; });
  table["with_wall"] = column<bool>(contacts, [](const auto& c) { return c.with_wall; });
  table["from"] = vectors(contacts, [](const auto& c) { return c.from; });
  table["to"] = vectors(contacts, [](const auto& c) { return c.to; });
  table["force"] = vectors(contacts, [](const auto& c) { return c.force; });
  table["deepest"] = column<double>(contacts, [](const auto& c) { return c.deepest; });
  table["touching"] = column<std::uint32_t>(contacts, [](const auto& c) { return c.touching; });
  table["bonded"] = column<bool>(contacts, [](const auto& c) { return c.bonded; });
  return table;
}

}  // namespace reckon::python
