// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "tables.hpp"

#include <variant>

#include "arrays.hpp"
#include "reckon/math/rotation.hpp"

namespace reckon::python {
namespace {

/// Common columns of current and saved grains.
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

py::object value_of(const Number& number) {
  return std::visit([](auto value) { return py::object{py::cast(value)}; }, number);
}

std::vector<double> doubles(const std::vector<Number>& numbers) {
  std::vector<double> values;
  values.reserve(numbers.size());
  for (const Number& number : numbers) {
    values.push_back(std::visit([](auto value) { return static_cast<double>(value); }, number));
  }
  return values;
}

/// A number, a vector as a tuple, or a symmetric tensor as its rows.
py::object value_of(const MeasuredQuantity& quantity) {
  if (quantity.components.empty()) return value_of(quantity.numbers.front());
  const std::vector<double> v = doubles(quantity.numbers);
  if (v.size() == 3) return tuple_of({v[0], v[1], v[2]});
  // xx, yy, zz, xy, yz, zx
  return rows_of(std::vector<Vec3>{{v[0], v[3], v[5]}, {v[3], v[1], v[4]}, {v[5], v[4], v[2]}});
}

}  // namespace

py::dict table_of(const std::vector<MeasuredQuantity>& quantities, const EnergyBudget& budget) {
  py::dict table;
  py::dict energy;
  std::vector<Vec3> wall_force;
  for (const MeasuredQuantity& quantity : quantities) {
    if (quantity.of_wall) {
      const std::vector<double> force = doubles(quantity.numbers);
      wall_force.push_back({force[0], force[1], force[2]});
      continue;
    }
    const py::object value = value_of(quantity);
    if (quantity.unit == "J") {
      energy[py::str(quantity.name)] = value;
    } else {
      table[py::str(quantity.name)] = value;
    }
  }
  energy["total"] = budget.total();
  table["energy"] = energy;
  table["wall_force"] = rows_of(wall_force);
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
