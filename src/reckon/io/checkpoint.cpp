// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/io/checkpoint.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/hdf5_file.hpp"

namespace reckon {
namespace {

// 2 added departed grains, 3 driven walls and stages, 4 the membrane, 5 the cell and bonds.
const Hdf5Kind kind{"checkpoint", 6};

/// How the parts of the state lie in columns. The same walk fills columns from the state, and the
/// state from columns: `Columns` offers number, vector, quaternion, id and flag.
template <class Columns, class Grain>
void walk_grain(Columns& columns, Grain& grain) {
  columns.id("id", grain.id);
  columns.id("shape", grain.shape);
  columns.flag("prescribed", grain.prescribed);
  columns.vector("position", "m", grain.position);
  columns.quaternion("orientation", grain.orientation);
  columns.vector("velocity", "m/s", grain.velocity);
  columns.vector("angular_velocity_body", "rad/s", grain.angular_velocity_body);
  columns.vector("angular_increment_body", "rad/s", grain.angular_increment_body);
  columns.number("lost_to_friction", "J", grain.ledger.friction);
  columns.number("lost_to_dashpots", "J", grain.ledger.dashpot);
  columns.number("lost_to_damping", "J", grain.ledger.damping);
  columns.number("work_of_body_forces", "J", grain.ledger.body_work);
  columns.number("work_of_walls", "J", grain.ledger.wall_work);
  if (columns.has_since(5)) columns.number("lost_to_fracture", "J", grain.ledger.fracture);
}

template <class Columns, class Pair, class Cement>
void walk_bond(Columns& columns, Pair& pair, Cement& bond) {
  columns.id("id_a", pair.id_a);
  columns.id("id_b", pair.id_b);
  columns.vector("arm_a", "m", bond.arm_a);
  columns.vector("arm_b", "m", bond.arm_b);
  columns.quaternion("turn", bond.turn);
  columns.vector("axis_a", "1", bond.axis_a);
  columns.number("radius", "m", bond.radius);
}

template <class Columns, class Spring>
void walk_spring(Columns& columns, Spring& spring) {
  columns.integer("node", spring.node);
  columns.flag("master_is_b", spring.master_is_b);
  columns.vector("shear_force", "N", spring.shear_force);
  columns.vector("normal", "1", spring.normal);
  if (columns.has_since(6)) columns.number("dashpot_push", "N", spring.dashpot_push);
}

template <class Columns, class Wall>
void walk_wall(Columns& columns, Wall& wall) {
  columns.vector("displacement", "m", wall.displacement);
  columns.vector("velocity", "m/s", wall.velocity);
  columns.vector("displacement_at_stage_start", "m", wall.displacement_at_stage_start);
}

/// Edges and rates as their diagonal and what is above it.
template <class Columns, class Matrix>
void walk_upper(Columns& columns, const char* diagonal, const char* above, const char* unit,
                Matrix& m) {
  columns.vector(diagonal, unit, m.diagonal);
  Vec3 rest{m.xy, m.xz, m.yz};
  columns.vector(above, unit, rest);
  if constexpr (!std::is_const_v<Matrix>) {
    m.xy = rest.x;
    m.xz = rest.y;
    m.yz = rest.z;
  }
}

/// One row where there is a cell, else none.
template <class Columns, class Cell>
void walk_cell(Columns& columns, Cell& cell) {
  walk_upper(columns, "edges", "lean", "m", cell.edges);
  walk_upper(columns, "edge_rates", "lean_rates", "m/s", cell.rates);
  walk_upper(columns, "edges_at_stage_start", "lean_at_stage_start", "m",
             cell.edges_at_stage_start);
  columns.vector("shear", "1", cell.shear);
  columns.vector("shear_at_stage_start", "1", cell.shear_at_stage_start);
  columns.number("work", "J", cell.work);
}

/// One row where the membrane is in place, else none.
template <class Columns, class Membrane>
void walk_membrane(Columns& columns, Membrane& membrane) {
  columns.vector("foot", "m", membrane.start.foot);
  columns.vector("axis", "1", membrane.start.axis_unit);
  columns.number("radius", "m", membrane.start.radius);
  columns.number("height", "m", membrane.start.height);
  columns.id("floor", membrane.floor);
  columns.id("lid", membrane.lid);
  columns.vector("floor_start", "m", membrane.floor_start);
  columns.vector("lid_start", "m", membrane.lid_start);
  columns.number("pressure_before", "Pa", membrane.pressure_before);
  columns.number("volume_at_stage_start", "m^3", membrane.volume_at_stage_start);
  columns.number("height_at_stage_start", "m", membrane.height_at_stage_start);
}

template <class Columns, class Node>
void walk_membrane_node(Columns& columns, Node& node) {
  columns.vector("position", "m", node.position);
  columns.vector("velocity", "m/s", node.velocity);
  columns.number("lost_to_friction", "J", node.ledger.friction);
  columns.number("lost_to_damping", "J", node.ledger.damping);
  columns.number("work_of_pressure", "J", node.ledger.wall_work);
}

template <class Columns, class Spring>
void walk_membrane_spring(Columns& columns, Spring& spring) {
  columns.integer("node", spring.node);
  columns.id("grain", spring.grain);
  columns.vector("shear_force", "N", spring.shear_force);
  columns.vector("normal", "1", spring.normal);
  if (columns.has_since(6)) columns.number("dashpot_push", "N", spring.dashpot_push);
}

/// Appends one row per walk to the columns of a table, which the first walk makes.
class Appender {
 public:
  Appender(std::string table, std::vector<CheckpointColumn>& columns)
      : table_{std::move(table)}, columns_{columns}, first_{columns.size()} {}

  /// To be called before each row.
  void begin_row() { next_ = first_; }
  /// Whether the file has what came with this version of it.
  [[nodiscard]] static bool has_since(unsigned /*version*/) { return true; }

  void number(const char* name, const char* unit, double value) { append(name, unit, {value}); }
  void vector(const char* name, const char* unit, const Vec3& v) {
    append<double, 3>(name, unit, {v.x, v.y, v.z});
  }
  void quaternion(const char* name, const Quaternion& q) {
    append<double, 4>(name, "1", {q.w, q.x, q.y, q.z});
  }
  template <class Id>
  void id(const char* name, const Id& value) {
    append<std::uint32_t, 1>(name, "1", {value.get()});
  }
  void integer(const char* name, std::uint32_t value) {
    append<std::uint32_t, 1>(name, "1", {value});
  }
  void integer(const char* name, std::uint64_t value) {
    append<std::uint64_t, 1>(name, "1", {value});
  }
  void flag(const char* name, bool value) {
    append<std::uint8_t, 1>(name, "1", {static_cast<std::uint8_t>(value ? 1 : 0)});
  }

 private:
  template <class Number = double, std::size_t width = 1>
  void append(const char* name, const char* unit, std::array<Number, width> row) {
    if (next_ == columns_.size()) {
      columns_.push_back({table_ + name, unit, width, std::vector<Number>{}});
    }
    auto& values = std::get<std::vector<Number>>(columns_[next_++].values);
    values.insert(values.end(), row.begin(), row.end());
  }

  std::string table_;
  std::vector<CheckpointColumn>& columns_;
  std::size_t first_;
  std::size_t next_{0};
};

/// Makes the columns of a table without any row, so that empty tables are in the file too.
template <class Walk>
void append_rows(const std::string& table, std::size_t rows, std::vector<CheckpointColumn>& columns,
                 Walk&& walk) {
  Appender appender{table, columns};
  const std::size_t first = columns.size();
  for (std::size_t row = 0; row < rows; ++row) {
    appender.begin_row();
    walk(appender, row);
  }
  if (rows > 0) return;
  appender.begin_row();
  walk(appender, 0);
  for (std::size_t c = first; c < columns.size(); ++c) {
    std::visit([](auto& values) { values.clear(); }, columns[c].values);
  }
}

/// Springs of all pairs behind each other, with where each pair's begin.
struct FlatSprings {
  std::vector<NodeSpring> springs;
  std::vector<std::uint64_t> first;  // per pair, and one past the end
};

template <class Pairs>
FlatSprings flatten(const Pairs& pairs) {
  FlatSprings flat;
  flat.first.push_back(0);
  for (const auto& pair : pairs) {
    flat.springs.insert(flat.springs.end(), pair.springs.begin(), pair.springs.end());
    flat.first.push_back(flat.springs.size());
  }
  return flat;
}

template <class T>
const T& row_or_blank(const std::vector<T>& rows, std::size_t row, const T& blank) {
  return row < rows.size() ? rows[row] : blank;
}

void append_springs(const std::string& table, const FlatSprings& flat,
                    std::vector<CheckpointColumn>& columns) {
  append_rows(table, flat.springs.size(), columns, [&](Appender& to, std::size_t row) {
    walk_spring(to, row_or_blank(flat.springs, row, NodeSpring{}));
  });
}

/// Reads the columns of one table row by row.
class Extractor {
 public:
  Extractor(std::string table, std::uint64_t rows, const Hdf5Reader& file)
      : table_{std::move(table)}, rows_{rows}, file_{file} {}

  void begin_row(std::size_t row) {
    row_ = row;
    next_ = 0;
  }
  [[nodiscard]] bool has_since(unsigned version) const { return file_.version() >= version; }
  void number(const char* name, const char*, double& value) { value = take<double, 1>(name)[0]; }
  void vector(const char* name, const char*, Vec3& v) {
    const auto row = take<double, 3>(name);
    v = {row[0], row[1], row[2]};
  }
  void quaternion(const char* name, Quaternion& q) {
    const auto row = take<double, 4>(name);
    q = {row[0], row[1], row[2], row[3]};
  }
  template <class Id>
  void id(const char* name, Id& value) {
    value = Id{take<std::uint32_t, 1>(name)[0]};
  }
  void integer(const char* name, std::uint32_t& value) { value = take<std::uint32_t, 1>(name)[0]; }
  void integer(const char* name, std::uint64_t& value) { value = take<std::uint64_t, 1>(name)[0]; }
  void flag(const char* name, bool& value) { value = take<std::uint8_t, 1>(name)[0] != 0; }

 private:
  template <class Number, std::size_t width>
  std::array<Number, width> take(const char* name) {
    if (next_ == columns_.size()) {
      const Hdf5Extents extents = width == 1 ? Hdf5Extents{rows_} : Hdf5Extents{rows_, width};
      columns_.push_back({table_ + name, {}, width, file_.read<Number>(table_ + name, extents)});
    }
    const auto& values = std::get<std::vector<Number>>(columns_[next_++].values);
    std::array<Number, width> row;
    for (std::size_t n = 0; n < width; ++n) row[n] = values[row_ * width + n];
    return row;
  }

  std::string table_;
  std::uint64_t rows_;
  const Hdf5Reader& file_;
  std::vector<CheckpointColumn> columns_;
  std::size_t row_{0};
  std::size_t next_{0};
};

[[noreturn]] void refuse(const Hdf5Reader& file, std::string reason) {
  throw Error{{.place = file.path().string(),
               .problem = "this checkpoint contradicts itself",
               .reason = std::move(reason),
               .fix = "Resume from another one."}};
}

std::uint64_t rows_of(const Hdf5Reader& file, const std::string& column) {
  const Hdf5Extents extents = file.extents(column);
  return extents.empty() ? 0 : extents[0];
}

std::vector<NodeSpring> read_springs(const Hdf5Reader& file, const std::string& table) {
  const std::uint64_t count = rows_of(file, table + "node");
  Extractor from{table, count, file};
  std::vector<NodeSpring> springs(count);
  for (std::size_t row = 0; row < count; ++row) {
    from.begin_row(row);
    walk_spring(from, springs[row]);
  }
  return springs;
}

/// Reads a table of contacts; `make(row, springs)` makes one.
template <class Make>
void read_contacts(const Hdf5Reader& file, const std::string& table, std::uint64_t count,
                   const std::string& spring_table, Make&& make) {
  const auto first = file.read<std::uint64_t>(table + "first_spring", {count + 1});
  const std::vector<NodeSpring> springs = read_springs(file, spring_table);
  if (first.front() != 0 || first.back() != springs.size()) {
    refuse(file, table + "first_spring does not cover the springs");
  }
  for (std::size_t row = 0; row < count; ++row) {
    if (first[row] > first[row + 1] || first[row + 1] > springs.size()) {
      refuse(file, table + "first_spring goes backwards");
    }
    const auto begin = springs.begin();
    make(row, std::vector<NodeSpring>(begin + static_cast<std::ptrdiff_t>(first[row]),
                                      begin + static_cast<std::ptrdiff_t>(first[row + 1])));
  }
}

void read_cell(const Hdf5Reader& file, std::optional<CellState>& cell) {
  const std::uint64_t rows = rows_of(file, "/cell/edges");
  if (rows == 0) return;
  if (rows > 1) refuse(file, "it has more than one cell");
  cell.emplace();
  Extractor from{"/cell/", rows, file};
  from.begin_row(0);
  walk_cell(from, *cell);
  for (const UpperMat3* edges : {&cell->edges, &cell->edges_at_stage_start}) {
    const Vec3& lengths = edges->diagonal;
    if (!is_finite(lengths) || !(std::min({lengths.x, lengths.y, lengths.z}) > 0)) {
      refuse(file, "its cell has an edge without length");
    }
  }
}

/// Gives the pairs their bonds; both are sorted by ids.
void read_bonds(const Hdf5Reader& file, SimulationState& state) {
  const std::uint64_t rows = rows_of(file, "/bond/radius");
  Extractor from{"/bond/", rows, file};
  auto pair = state.pair_springs.begin();
  for (std::size_t row = 0; row < rows; ++row) {
    PairSprings wanted;
    Bond bond;
    from.begin_row(row);
    walk_bond(from, wanted, bond);
    pair = std::find_if(pair, state.pair_springs.end(), [&](const PairSprings& p) {
      return p.id_a == wanted.id_a && p.id_b == wanted.id_b;
    });
    if (pair == state.pair_springs.end()) refuse(file, "a bond is of a pair that is not listed");
    pair->bond = bond;
  }
  const auto broken = file.read<std::uint64_t>("/run/broken_bonds", {2});
  state.broken_bonds = {broken[0], broken[1]};
}

void read_membrane(const Hdf5Reader& file, MembraneState& membrane) {
  membrane.nodes.resize(rows_of(file, "/membrane_node/position"));
  const std::uint64_t rows = rows_of(file, "/membrane/radius");
  if (rows != (membrane.in_place() ? 1U : 0U)) {
    refuse(file, "it has nodes of a membrane without its place, or the other way round");
  }
  Extractor place{"/membrane/", rows, file};
  if (rows > 0) {
    place.begin_row(0);
    walk_membrane(place, membrane);
  }
  Extractor nodes{"/membrane_node/", membrane.nodes.size(), file};
  for (std::size_t row = 0; row < membrane.nodes.size(); ++row) {
    nodes.begin_row(row);
    walk_membrane_node(nodes, membrane.nodes[row]);
  }
  membrane.springs.resize(rows_of(file, "/membrane_spring/node"));
  Extractor springs{"/membrane_spring/", membrane.springs.size(), file};
  for (std::size_t row = 0; row < membrane.springs.size(); ++row) {
    springs.begin_row(row);
    walk_membrane_spring(springs, membrane.springs[row]);
  }
}

}  // namespace

std::vector<CheckpointColumn> to_columns(const SimulationState& state) {
  std::vector<CheckpointColumn> columns;
  append_rows("/grain/", state.grains.size(), columns, [&](Appender& to, std::size_t row) {
    walk_grain(to, row_or_blank(state.grains, row, GrainState{}));
  });
  const DepartedGrain no_grain;
  append_rows("/departed/", state.departed.size(), columns, [&](Appender& to, std::size_t row) {
    const DepartedGrain& gone = row_or_blank(state.departed, row, no_grain);
    to.integer("step", gone.step);
    walk_grain(to, gone.grain);
  });
  const DrivenWall no_wall;
  append_rows("/driven_wall/", state.driven_walls.size(), columns,
              [&](Appender& to, std::size_t row) {
                walk_wall(to, row_or_blank(state.driven_walls, row, no_wall));
              });
  columns.push_back({"/stage/start", "1", 1, state.stage_starts});
  const MembraneState& membrane = state.membrane;
  append_rows("/membrane/", membrane.in_place() ? 1 : 0, columns,
              [&](Appender& to, std::size_t) { walk_membrane(to, membrane); });
  append_rows("/membrane_node/", membrane.nodes.size(), columns,
              [&](Appender& to, std::size_t row) {
                walk_membrane_node(to, row_or_blank(membrane.nodes, row, MembraneNode{}));
              });
  append_rows("/membrane_spring/", membrane.springs.size(), columns,
              [&](Appender& to, std::size_t row) {
                walk_membrane_spring(to, row_or_blank(membrane.springs, row, MembraneSpring{}));
              });
  const CellState cell = state.cell.value_or(CellState{});
  append_rows("/cell/", state.cell ? 1 : 0, columns,
              [&](Appender& to, std::size_t) { walk_cell(to, cell); });
  const PairSprings no_pair;
  append_rows("/pair/", state.pair_springs.size(), columns, [&](Appender& to, std::size_t row) {
    const PairSprings& pair = row_or_blank(state.pair_springs, row, no_pair);
    to.id("id_a", pair.id_a);
    to.id("id_b", pair.id_b);
  });
  const FlatSprings of_pairs = flatten(state.pair_springs);
  columns.push_back({"/pair/first_spring", "1", 1, of_pairs.first});
  append_springs("/pair_spring/", of_pairs, columns);
  std::vector<PairSprings> bonded;
  for (const PairSprings& pair : state.pair_springs) {
    if (pair.bond) bonded.push_back({pair.id_a, pair.id_b, {}, pair.bond});
  }
  append_rows("/bond/", bonded.size(), columns, [&](Appender& to, std::size_t row) {
    const PairSprings& pair = row_or_blank(bonded, row, no_pair);
    const Bond bond = pair.bond.value_or(Bond{});
    walk_bond(to, pair, bond);
  });
  columns.push_back({"/run/broken_bonds", "1", 1,
                     std::vector{state.broken_bonds.in_tension, state.broken_bonds.in_shear}});
  const WallSprings no_contact;
  append_rows("/wall_contact/", state.wall_springs.size(), columns,
              [&](Appender& to, std::size_t row) {
                const WallSprings& contact = row_or_blank(state.wall_springs, row, no_contact);
                to.id("grain", contact.grain);
                to.id("wall", contact.wall);
              });
  const FlatSprings of_walls = flatten(state.wall_springs);
  columns.push_back({"/wall_contact/first_spring", "1", 1, of_walls.first});
  append_springs("/wall_spring/", of_walls, columns);
  return columns;
}

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  Hdf5Writer file{path, kind};
  const auto one = [](auto value) { return std::vector<decltype(value)>{value}; };
  file.write("/run/step", one(checkpoint.state.step), {1}, "1");
  file.write("/run/time_step", one(checkpoint.time_step), {1}, "s");
  file.write("/run/energy_at_start", one(checkpoint.energy_at_start), {1}, "J");
  file.write("/run/shape_digest", checkpoint.shape_digests, {checkpoint.shape_digests.size()}, "1");
  file.write("/run/acceleration_digest", one(checkpoint.acceleration_digest), {1}, "1");
  const std::vector<std::uint8_t> scene(checkpoint.scene.begin(), checkpoint.scene.end());
  file.write("/run/scene", scene, {scene.size()}, "UTF-8");
  for (const CheckpointColumn& column : to_columns(checkpoint.state)) {
    std::visit(
        [&](const auto& values) {
          const std::uint64_t rows = values.size() / column.width;
          file.write(column.name, values,
                     column.width == 1 ? Hdf5Extents{rows} : Hdf5Extents{rows, column.width},
                     column.unit);
        },
        column.values);
  }
  file.finish();
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  const Hdf5Reader file{path, kind};
  Checkpoint checkpoint;
  checkpoint.state.step = file.read<std::uint64_t>("/run/step", {1})[0];
  checkpoint.time_step = file.read<double>("/run/time_step", {1})[0];
  checkpoint.energy_at_start = file.read<double>("/run/energy_at_start", {1})[0];
  checkpoint.shape_digests =
      file.read<std::uint64_t>("/run/shape_digest", {rows_of(file, "/run/shape_digest")});
  checkpoint.acceleration_digest = file.read<std::uint64_t>("/run/acceleration_digest", {1})[0];
  const auto scene = file.read<std::uint8_t>("/run/scene", {rows_of(file, "/run/scene")});
  checkpoint.scene.assign(scene.begin(), scene.end());

  SimulationState& state = checkpoint.state;
  state.grains.resize(rows_of(file, "/grain/id"));
  Extractor grains{"/grain/", state.grains.size(), file};
  for (std::size_t row = 0; row < state.grains.size(); ++row) {
    grains.begin_row(row);
    walk_grain(grains, state.grains[row]);
    if (state.grains[row].shape.get() >= checkpoint.shape_digests.size()) {
      refuse(file, "a grain has a shape that is not in the library");
    }
  }
  if (file.version() >= 2) {
    state.departed.resize(rows_of(file, "/departed/step"));
    Extractor departed{"/departed/", state.departed.size(), file};
    for (std::size_t row = 0; row < state.departed.size(); ++row) {
      departed.begin_row(row);
      departed.integer("step", state.departed[row].step);
      walk_grain(departed, state.departed[row].grain);
      if (state.departed[row].grain.shape.get() >= checkpoint.shape_digests.size()) {
        refuse(file, "a departed grain has a shape that is not in the library");
      }
    }
  }
  if (file.version() >= 3) {
    state.driven_walls.resize(rows_of(file, "/driven_wall/displacement"));
    Extractor walls{"/driven_wall/", state.driven_walls.size(), file};
    for (std::size_t row = 0; row < state.driven_walls.size(); ++row) {
      walls.begin_row(row);
      walk_wall(walls, state.driven_walls[row]);
    }
    state.stage_starts = file.read<std::uint64_t>("/stage/start", {rows_of(file, "/stage/start")});
    if (!std::is_sorted(state.stage_starts.begin(), state.stage_starts.end())) {
      refuse(file, "a stage starts before the one before it");
    }
  }
  if (file.version() >= 4) read_membrane(file, state.membrane);
  if (file.version() >= 5) read_cell(file, state.cell);
  const std::uint64_t pairs = rows_of(file, "/pair/id_a");
  const auto id_a = file.read<std::uint32_t>("/pair/id_a", {pairs});
  const auto id_b = file.read<std::uint32_t>("/pair/id_b", {pairs});
  read_contacts(
      file, "/pair/", pairs, "/pair_spring/",
      [&](std::size_t row, std::vector<NodeSpring> springs) {
        state.pair_springs.push_back({GrainId{id_a[row]}, GrainId{id_b[row]}, std::move(springs)});
      });
  if (file.version() >= 5) read_bonds(file, state);
  const std::uint64_t contacts = rows_of(file, "/wall_contact/grain");
  const auto grain = file.read<std::uint32_t>("/wall_contact/grain", {contacts});
  const auto wall = file.read<std::uint32_t>("/wall_contact/wall", {contacts});
  read_contacts(
      file, "/wall_contact/", contacts, "/wall_spring/",
      [&](std::size_t row, std::vector<NodeSpring> springs) {
        state.wall_springs.push_back({GrainId{grain[row]}, WallId{wall[row]}, std::move(springs)});
      });
  return checkpoint;
}

}  // namespace reckon
