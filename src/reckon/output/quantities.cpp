// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/quantities.hpp"

#include <concepts>
#include <iterator>
#include <utility>

namespace reckon {
namespace {

using Names = std::vector<std::string>;

const Names along_axes{"_x", "_y", "_z"};
const Names of_tensor{"_xx", "_yy", "_zz", "_xy", "_yz", "_zx"};
const Names across_axes{"_xy", "_xz", "_yz"};

std::vector<Number> numbers(double value) { return {value}; }
template <std::integral Count>
std::vector<Number> numbers(Count value) {
  return {static_cast<std::uint64_t>(value)};
}
std::vector<Number> numbers(const Vec3& v) { return {v.x, v.y, v.z}; }
/// The six numbers of a tensor's symmetric part.
std::vector<Number> numbers(const Mat3& tensor) {
  const Mat3 s = symmetric_part(tensor);
  return {s.row_x.x, s.row_y.y, s.row_z.z, s.row_x.y, s.row_y.z, s.row_z.x};
}

/// `get` takes what `part` of a row holds and returns a number, a vector or a tensor.
template <class Part, class Get>
HistoryQuantity quantity(QuantityName name, Part part, Get get) {
  return {std::move(name), [part, get](const HistoryRow& row) { return numbers(get(part(row))); }};
}

/// Entries of the table whose numbers come from the same part of a row.
template <class Part>
class Entries {
 public:
  explicit Entries(Part part) : part_{part} {}

  template <class Get>
  Entries& add(std::string name, std::string unit, std::string meaning, Get get,
               Names components = {}) {
    list_.push_back(quantity(
        {std::move(name), std::move(unit), std::move(meaning), std::move(components)}, part_, get));
    return *this;
  }
  [[nodiscard]] std::vector<HistoryQuantity> take() { return std::move(list_); }

 private:
  Part part_;
  std::vector<HistoryQuantity> list_;
};

const Measurement& measurement(const HistoryRow& row) { return row.measurement; }
const HistoryRow& whole(const HistoryRow& row) { return row; }
const SampleMeasurement& sample(const HistoryRow& row) { return *row.sample; }
const CellState& cell(const HistoryRow& row) { return *row.cell; }

using M = const Measurement&;
using S = const SampleMeasurement&;

std::vector<HistoryQuantity> of_every_run() {
  Entries list{whole};
  const auto add = [&](const char* name, const char* unit, const char* meaning, auto get,
                       const Names& components = {}) {
    list.add(
        name, unit, meaning, [get](const HistoryRow& row) { return get(row.measurement); },
        components);
  };
  add("step", "", "number of steps since the start", [](M m) { return m.step; });
  add("time", "s", "simulated time", [](M m) { return m.time; });
  add("translation", "J", "kinetic energy of translation",
      [](M m) { return m.energy.translation; });
  add("rotation", "J", "kinetic energy of rotation", [](M m) { return m.energy.rotation; });
  add("gravity", "J", "potential energy of gravity, zero at the origin",
      [](M m) { return m.energy.gravity; });
  add("elastic", "J", "energy stored in contact springs", [](M m) { return m.energy.elastic; });
  add("friction", "J", "energy lost to sliding since the start",
      [](M m) { return m.energy.friction; });
  add("dashpot", "J", "energy lost to contact dashpots since the start",
      [](M m) { return m.energy.dashpot; });
  add("damping", "J", "energy lost to global damping since the start",
      [](M m) { return m.energy.damping; });
  add("body_work", "J", "work of body forces other than gravity since the start",
      [](M m) { return m.energy.body_work; });
  add("wall_work", "J",
      "work of moving walls, of the periodic cell and of grains with prescribed motion since the "
      "start",
      [](M m) { return m.energy.wall_work; });
  add("departed", "J", "energy of the grains that left through an outflow, as they left",
      [](M m) { return m.energy.departed; });
  list.add(
      "balance_error", "J",
      "stored plus lost energy minus work done, less what it was at the start: the error of "
      "time stepping",
      [](const HistoryRow& row) { return row.measurement.energy.total() - row.energy_at_start; });
  add("grains", "", "grains in the simulation", [](M m) { return m.grains; });
  add("departed", "", "grains that left through an outflow since the start",
      [](M m) { return m.departed; });
  add("contacts", "", "pairs of grains that touch or are bonded", [](M m) { return m.contacts; });
  add("wall_contacts", "", "touching pairs of grain and wall", [](M m) { return m.wall_contacts; });
  add("touching_nodes", "", "nodes in contact", [](M m) { return m.touching_nodes; });
  add("coordination", "", "contacts per grain, walls included", [](M m) { return m.coordination; });
  add("unbalanced_ratio", "",
      "mean net force on a grain over mean contact force; inf where no contact carries a force",
      [](M m) { return m.unbalanced_ratio; });
  add("deepest_overlap", "m", "largest penetration of a node",
      [](M m) { return m.deepest_overlap; });
  add("largest_speed", "m/s", "speed of the fastest grain's centre",
      [](M m) { return m.largest_speed; });
  add(
      "momentum", "kg m/s", "momentum of all grains", [](M m) { return m.momentum; }, along_axes);
  add("carried_share", "", "share of the grains' mass that a contact pushes",
      [](M m) { return m.carried_share; });
  add("kinetic_ratio", "",
      "kinetic energy of the grains over what holds them: the energy in contact springs, and that "
      "which lifts each grain by its diameter against gravity",
      [](M m) { return m.kinetic_ratio; });
  add("overlap_ratio", "",
      "largest penetration over the diameter of the smaller grain (of a sphere of its volume)",
      [](M m) { return m.overlap_ratio; });
  add("outside", "", "grains whose centre is behind a wall", [](M m) { return m.outside; });
  return list.take();
}

std::vector<HistoryQuantity> of_walls(std::span<const Wall> walls) {
  std::vector<HistoryQuantity> list;
  list.reserve(walls.size());
  for (std::size_t w = 0; w < walls.size(); ++w) {
    const std::string& wall = walls[w].name;
    list.push_back(
        quantity({wall + ":f", "N", "force of the grains on wall " + wall, {"x", "y", "z"}, true},
                 measurement, [w](M m) { return m.wall_force[w]; }));
  }
  return list;
}

std::vector<HistoryQuantity> of_membrane() {
  return Entries{measurement}
      .add("membrane_pressure", "Pa", "on the membrane; 0 before it is in place",
           [](M m) { return m.membrane_pressure; })
      .add("membrane_stretch", "J",
           "energy stored in the membrane's bonds, which `elastic_J` holds too",
           [](M m) { return m.membrane_stretch; })
      .add("membrane_nodes", "", "nodes of the membrane that touch a grain",
           [](M m) { return m.membrane_nodes; })
      .take();
}

std::vector<HistoryQuantity> of_cell() {
  using C = const CellState&;
  return Entries{cell}
      .add(
          "cell_edge", "m", "edges of the periodic cell along the axes",
          [](C c) { return c.edges.diagonal; }, along_axes)
      .add(
          "cell_lean", "m", "how far the edge along the second axis leans along the first",
          [](C c) {
            return Vec3{c.edges.xy, c.edges.xz, c.edges.yz};
          },
          across_axes)
      .add(
          "cell_shear", "",
          "shear strain since the stage began, along the first axis across the second",
          [](C c) { return c.shear - c.shear_at_stage_start; }, across_axes)
      .take();
}

std::vector<HistoryQuantity> of_bonds() {
  return Entries{measurement}
      .add("bonds", "", "bonds that hold", [](M m) { return m.bonds; })
      .add("broken_in_tension", "", "bonds that broke in tension since the start",
           [](M m) { return m.broken_bonds.in_tension; })
      .add("broken_in_shear", "", "bonds that broke in shear since the start",
           [](M m) { return m.broken_bonds.in_shear; })
      .add("fracture", "J", "energy that was lost as bonds broke, since the start",
           [](M m) { return m.energy.fracture; })
      .take();
}

std::vector<HistoryQuantity> of_stages() {
  return Entries{whole}
      .add("stage", "", "the stage under way, counted from 1",
           [](const HistoryRow& row) { return row.stage.value_or(0); })
      .take();
}

std::vector<HistoryQuantity> of_sample() {
  return Entries{sample}
      .add("volume", "m^3",
           "of the space that the walls close off, or of the periodic cell; 0 where it is open",
           [](S s) { return s.volume; })
      .add(
          "size", "m", "edges of its bounding box", [](S s) { return s.size; }, along_axes)
      .add("void_ratio", "", "volume that is not solid over volume that is",
           [](S s) { return s.void_ratio; })
      .add(
          "strain", "", "logarithmic strain since the stage began, compression positive",
          [](S s) { return s.strain; }, along_axes)
      .add("volumetric_strain", "", "likewise, of the volume",
           [](S s) { return s.volumetric_strain; })
      .add(
          "stress", "Pa",
          "stress of Love and Weber from all contacts, compression positive, symmetric part",
          [](S s) { return s.stress; }, of_tensor)
      .add(
          "wall_stress", "Pa", "the same from forces on the walls alone",
          [](S s) { return s.wall_stress; }, of_tensor)
      .add("mean_stress", "Pa", "p, a third of the trace of the stress",
           [](S s) { return s.invariants.mean; })
      .add("deviator", "Pa", "q = sqrt(3 J2) of the stress",
           [](S s) { return s.invariants.deviator; })
      .add("friction_angle", "deg", "mobilised: sine is (sigma_1 - sigma_3) / (sigma_1 + sigma_3)",
           [](S s) { return s.invariants.friction_angle; })
      .add("inertial_number", "",
           "largest rate of strain times mean diameter times sqrt(density / p)",
           [](S s) { return s.inertial_number; })
      .add(
          "total_strain", "", "logarithmic strain since step 0, compression positive",
          [](S s) { return s.total_strain; }, along_axes)
      .add("total_volumetric_strain", "", "likewise, of the volume",
           [](S s) { return s.total_volumetric_strain; })
      .add("axial_strain", "",
           "the same along the axis that the test drives: that of the stage, or of the last stage "
           "before or the next one that drives walls by rate or speed, else z; of a cell that is "
           "sheared, its shear strain",
           [](S s) { return s.axial_strain; })
      .add("axial_deviator", "Pa",
           "signed q along that axis, compression positive: the stress along it less the mean of "
           "the other two; of a cell that is sheared, sqrt(3) times the shear stress",
           [](S s) { return s.axial_deviator; })
      .add("mechanical_coordination", "",
           "contacts per grain over grains with at least two of them",
           [](S s) { return s.mechanical_coordination; })
      .add("rattlers", "", "grains with fewer than two contacts", [](S s) { return s.rattlers; })
      .add(
          "contact_tensor", "", "mean of n (x) n over contact normals between grains",
          [](S s) { return s.contact_tensor; }, of_tensor)
      .add(
          "branch_tensor", "", "the same over directions from centre to centre of touching grains",
          [](S s) { return s.branch_tensor; }, of_tensor)
      .add("mean_force", "N", "mean contact force between grains", [](S s) { return s.mean_force; })
      .add("force_variation", "", "standard deviation of the contact force over its mean",
           [](S s) { return s.force_variation; })
      .add("largest_force", "", "largest contact force over the mean",
           [](S s) { return s.largest_force; })
      .take();
}

/// The unit as the end of a column's name: "kg m/s" gives "_kg_m_per_s".
std::string suffix(const std::string& unit) {
  std::string end;
  if (!unit.empty()) end = "_";
  for (const char letter : unit) {
    if (letter == '/') {
      end += "_per_";
    } else if (letter != '^') {
      end += letter == ' ' ? '_' : letter;
    }
  }
  return end;
}

}  // namespace

std::vector<std::string> QuantityName::columns() const {
  if (components.empty()) return {name + suffix(unit)};
  std::vector<std::string> all;
  all.reserve(components.size());
  for (const std::string& component : components) all.push_back(name + component + suffix(unit));
  return all;
}

HistoryLayout layout_of(const SimulationSetup& setup, bool sample) {
  return {setup.walls,
          setup.membrane.has_value(),
          setup.cell.has_value(),
          setup.contact.bond.has_value(),
          !setup.stages.empty(),
          sample};
}

std::vector<QuantityGroup> quantity_groups(std::span<const Wall> walls) {
  using Layout = const HistoryLayout&;
  return {
      {"Every run", "", [](Layout) { return true; }, of_every_run()},
      {"Walls", "There are three for each wall of the scene; a box counts as its planes.",
       [](Layout layout) { return !layout.walls.empty(); }, of_walls(walls)},
      {"Membrane",
       "They are there where the scene has a `[membrane]`. The other columns include its contacts, "
       "its energies and the work of the pressure on it.",
       [](Layout layout) { return layout.membrane; }, of_membrane()},
      {"Periodic cell",
       "They are there where the scene has a `[cell]`. Then speeds, momentum and kinetic energies "
       "are those of motion against the cell's own, and `wall_stress_...` is 0, as there are no "
       "forces on walls.",
       [](Layout layout) { return layout.cell; }, of_cell()},
      {"Cement", "They are there where the scene has a `[bond]`.",
       [](Layout layout) { return layout.bonds; }, of_bonds()},
      {"Stages",
       "It is there where the scene has stages. The row at the last step of a stage belongs to "
       "that stage.",
       [](Layout layout) { return layout.stages; }, of_stages()},
      {"Sample", "They are there where `output.sample` is true.",
       [](Layout layout) { return layout.sample; }, of_sample()},
  };
}

std::vector<HistoryQuantity> quantities_of(const HistoryLayout& layout) {
  std::vector<HistoryQuantity> found;
  for (QuantityGroup& group : quantity_groups(layout.walls)) {
    if (!group.is_in(layout)) continue;
    found.insert(found.end(), std::make_move_iterator(group.quantities.begin()),
                 std::make_move_iterator(group.quantities.end()));
  }
  return found;
}

std::vector<MeasuredQuantity> measured(std::span<const HistoryQuantity> quantities,
                                       const HistoryRow& row) {
  std::vector<MeasuredQuantity> found;
  found.reserve(quantities.size());
  for (const HistoryQuantity& quantity : quantities) {
    const QuantityName& name = quantity;
    found.push_back({name, quantity.numbers(row)});
  }
  return found;
}

void write_measured(JsonWriter& json, std::span<const MeasuredQuantity> quantities) {
  for (const MeasuredQuantity& quantity : quantities) {
    const std::vector<std::string> columns = quantity.columns();
    for (std::size_t n = 0; n < columns.size(); ++n) {
      std::visit([&](auto value) { json.value(columns[n], value); }, quantity.numbers[n]);
    }
  }
}

}  // namespace reckon
