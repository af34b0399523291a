// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/checkpoint.hpp"

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "reckon/output/checkpoint_tables.hpp"

namespace reckon {
namespace {

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

/// A row per element; an empty table has its columns too.
template <class Row, class Walk>
void append_rows(const std::string& table, const std::vector<Row>& rows,
                 std::vector<CheckpointColumn>& columns, Walk&& walk) {
  Appender appender{table, columns};
  const std::size_t first = columns.size();
  for (const Row& row : rows) {
    appender.begin_row();
    walk(appender, row);
  }
  if (!rows.empty()) return;
  appender.begin_row();
  const Row blank{};
  walk(appender, blank);
  for (std::size_t c = first; c < columns.size(); ++c) {
    std::visit([](auto& values) { values.clear(); }, columns[c].values);
  }
}

/// The only row of a table, or none.
template <class Row>
std::vector<Row> row_if(bool present, const Row& row) {
  return present ? std::vector<Row>{row} : std::vector<Row>{};
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

template <class Contacts, class Walk>
void append_contacts(const std::string& table, const Contacts& contacts,
                     const std::string& spring_table, std::vector<CheckpointColumn>& columns,
                     Walk&& walk) {
  append_rows(table, contacts, columns, walk);
  const FlatSprings flat = flatten(contacts);
  columns.push_back({table + "first_spring", "1", 1, flat.first});
  append_rows(spring_table, flat.springs, columns,
              [](Appender& to, const NodeSpring& spring) { walk_spring(to, spring); });
}

void append_membrane(const MembraneState& membrane, std::vector<CheckpointColumn>& columns) {
  append_rows("/membrane/", row_if(membrane.in_place(), membrane), columns,
              [](Appender& to, const MembraneState& row) { walk_membrane(to, row); });
  append_rows("/membrane_node/", membrane.nodes, columns,
              [](Appender& to, const MembraneNode& node) { walk_membrane_node(to, node); });
  append_rows("/membrane_spring/", membrane.springs, columns,
              [](Appender& to, const MembraneSpring& spring) { walk_membrane_spring(to, spring); });
}

void append_bonds(const std::vector<PairSprings>& pairs, std::vector<CheckpointColumn>& columns) {
  std::vector<PairSprings> bonded;
  for (const PairSprings& pair : pairs) {
    if (pair.bond) bonded.push_back({pair.id_a, pair.id_b, {}, pair.bond});
  }
  append_rows("/bond/", bonded, columns, [](Appender& to, const PairSprings& pair) {
    const Bond bond = pair.bond.value_or(Bond{});
    walk_bond(to, pair, bond);
  });
}

}  // namespace

std::vector<CheckpointColumn> to_columns(const SimulationState& state) {
  std::vector<CheckpointColumn> columns;
  append_rows("/grain/", state.grains, columns,
              [](Appender& to, const GrainState& grain) { walk_grain(to, grain); });
  append_rows("/departed/", state.departed, columns,
              [](Appender& to, const DepartedGrain& departed) { walk_departed(to, departed); });
  append_rows("/driven_wall/", state.driven_walls, columns,
              [](Appender& to, const DrivenWall& wall) { walk_wall(to, wall); });
  columns.push_back({"/stage/start", "1", 1, state.stage_starts});
  append_membrane(state.membrane, columns);
  append_rows("/cell/", row_if(state.cell.has_value(), state.cell.value_or(CellState{})), columns,
              [](Appender& to, const CellState& cell) { walk_cell(to, cell); });
  append_contacts("/pair/", state.pair_springs, "/pair_spring/", columns,
                  [](Appender& to, const PairSprings& pair) { walk_pair(to, pair); });
  append_bonds(state.pair_springs, columns);
  columns.push_back({"/run/broken_bonds", "1", 1,
                     std::vector{state.broken_bonds.in_tension, state.broken_bonds.in_shear}});
  append_contacts("/wall_contact/", state.wall_springs, "/wall_spring/", columns,
                  [](Appender& to, const WallSprings& contact) { walk_wall_contact(to, contact); });
  return columns;
}

void write_column(Hdf5Writer& file, const CheckpointColumn& column) {
  std::visit(
      [&](const auto& values) {
        const std::uint64_t rows = values.size() / column.width;
        file.write(column.name, values,
                   column.width == 1 ? Hdf5Extents{rows} : Hdf5Extents{rows, column.width},
                   column.unit);
      },
      column.values);
}

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  Hdf5Writer file{path, checkpoint_kind};
  const auto one = [](auto value) { return std::vector<decltype(value)>{value}; };
  file.write("/run/step", one(checkpoint.state.step), {1}, "1");
  file.write("/run/time_step", one(checkpoint.time_step), {1}, "s");
  file.write("/run/energy_at_start", one(checkpoint.energy_at_start), {1}, "J");
  file.write("/run/shape_digest", checkpoint.shape_digests, {checkpoint.shape_digests.size()}, "1");
  file.write("/run/acceleration_digest", one(checkpoint.acceleration_digest), {1}, "1");
  std::vector<std::uint64_t> since;
  if (checkpoint.goal_met_since) since.push_back(*checkpoint.goal_met_since);
  file.write("/run/goal_met_since", since, {since.size()}, "1");
  const std::vector<std::uint8_t> scene(checkpoint.scene.begin(), checkpoint.scene.end());
  file.write("/run/scene", scene, {scene.size()}, "UTF-8");
  for (const CheckpointColumn& column : to_columns(checkpoint.state)) {
    write_column(file, column);
  }
  file.finish();
}

}  // namespace reckon
