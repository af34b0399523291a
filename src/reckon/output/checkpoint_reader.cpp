// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/output/checkpoint.hpp"
#include "reckon/output/checkpoint_tables.hpp"

namespace reckon {
namespace {

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

/// No more than the file has bytes: columns are stored as they are.
std::uint64_t rows_of(const Hdf5Reader& file, const std::string& column) {
  const Hdf5Extents extents = file.extents(column);
  const std::uint64_t rows = extents.empty() ? 0 : extents[0];
  if (rows > std::filesystem::file_size(file.path())) {
    refuse(file, fmt::format("{} claims {} rows, more than the file holds", column, rows));
  }
  return rows;
}

/// The rows of a table; `column` gives their number.
template <class Row, class Walk>
std::vector<Row> read_rows(const Hdf5Reader& file, const std::string& table, const char* column,
                           Walk&& walk) {
  std::vector<Row> rows(rows_of(file, table + column));
  Extractor from{table, rows.size(), file};
  for (std::size_t n = 0; n < rows.size(); ++n) {
    from.begin_row(n);
    walk(from, rows[n]);
  }
  return rows;
}

/// Reads a table of contacts and gives each its springs.
template <class Contact, class Walk>
std::vector<Contact> read_contacts(const Hdf5Reader& file, const std::string& table,
                                   const char* column, const std::string& spring_table,
                                   Walk&& walk) {
  std::vector<Contact> contacts = read_rows<Contact>(file, table, column, walk);
  const auto first = file.read<std::uint64_t>(table + "first_spring", {contacts.size() + 1});
  const auto springs = read_rows<NodeSpring>(
      file, spring_table, "node", [](Extractor& from, NodeSpring& row) { walk_spring(from, row); });
  if (first.front() != 0 || first.back() != springs.size()) {
    refuse(file, table + "first_spring does not cover the springs");
  }
  for (std::size_t row = 0; row < contacts.size(); ++row) {
    if (first[row] > first[row + 1] || first[row + 1] > springs.size()) {
      refuse(file, table + "first_spring goes backwards");
    }
    contacts[row].springs.assign(springs.begin() + static_cast<std::ptrdiff_t>(first[row]),
                                 springs.begin() + static_cast<std::ptrdiff_t>(first[row + 1]));
  }
  return contacts;
}

void check_shape(const Hdf5Reader& file, const GrainState& grain, std::size_t shapes) {
  if (grain.shape.get() >= shapes) refuse(file, "a grain has a shape that is not in the library");
}

void read_driven_walls(const Hdf5Reader& file, SimulationState& state) {
  state.driven_walls =
      read_rows<DrivenWall>(file, "/driven_wall/", "displacement",
                            [](Extractor& from, DrivenWall& wall) { walk_wall(from, wall); });
  state.stage_starts = file.read<std::uint64_t>("/stage/start", {rows_of(file, "/stage/start")});
  if (!std::is_sorted(state.stage_starts.begin(), state.stage_starts.end())) {
    refuse(file, "a stage starts before the one before it");
  }
}

void read_membrane(const Hdf5Reader& file, MembraneState& membrane) {
  const auto places = read_rows<MembraneState>(
      file, "/membrane/", "radius",
      [](Extractor& from, MembraneState& row) { walk_membrane(from, row); });
  if (!places.empty()) membrane = places.front();
  membrane.nodes = read_rows<MembraneNode>(
      file, "/membrane_node/", "position",
      [](Extractor& from, MembraneNode& node) { walk_membrane_node(from, node); });
  membrane.springs = read_rows<MembraneSpring>(
      file, "/membrane_spring/", "node",
      [](Extractor& from, MembraneSpring& spring) { walk_membrane_spring(from, spring); });
  if (places.size() != (membrane.in_place() ? 1U : 0U)) {
    refuse(file, "it has nodes of a membrane without its place, or the other way round");
  }
}

void read_cell(const Hdf5Reader& file, std::optional<CellState>& cell) {
  const auto cells = read_rows<CellState>(
      file, "/cell/", "edges", [](Extractor& from, CellState& row) { walk_cell(from, row); });
  if (cells.empty()) return;
  if (cells.size() > 1) refuse(file, "it has more than one cell");
  cell = cells.front();
  for (const UpperMat3* edges : {&cell->edges, &cell->edges_at_stage_start}) {
    const Vec3& lengths = edges->diagonal;
    if (!is_finite(lengths) || !(std::min({lengths.x, lengths.y, lengths.z}) > 0)) {
      refuse(file, "its cell has an edge without length");
    }
  }
}

/// Gives the pairs their bonds; both are sorted by ids.
void read_bonds(const Hdf5Reader& file, SimulationState& state) {
  const auto bonded = read_rows<PairSprings>(
      file, "/bond/", "radius",
      [](Extractor& from, PairSprings& row) { walk_bond(from, row, row.bond.emplace()); });
  auto pair = state.pair_springs.begin();
  for (const PairSprings& wanted : bonded) {
    pair = std::find_if(pair, state.pair_springs.end(), [&](const PairSprings& p) {
      return p.id_a == wanted.id_a && p.id_b == wanted.id_b;
    });
    if (pair == state.pair_springs.end()) refuse(file, "a bond is of a pair that is not listed");
    pair->bond = wanted.bond;
  }
  const auto broken = file.read<std::uint64_t>("/run/broken_bonds", {2});
  state.broken_bonds = {broken[0], broken[1]};
}

SimulationState read_state(const Hdf5Reader& file, std::size_t shapes) {
  SimulationState state;
  state.step = file.read<std::uint64_t>("/run/step", {1})[0];
  state.grains = read_rows<GrainState>(
      file, "/grain/", "id", [](Extractor& from, GrainState& grain) { walk_grain(from, grain); });
  for (const GrainState& grain : state.grains) check_shape(file, grain, shapes);
  if (file.version() >= 2) {
    state.departed = read_rows<DepartedGrain>(
        file, "/departed/", "step",
        [](Extractor& from, DepartedGrain& departed) { walk_departed(from, departed); });
    for (const DepartedGrain& departed : state.departed) {
      check_shape(file, departed.grain, shapes);
    }
  }
  if (file.version() >= 3) read_driven_walls(file, state);
  if (file.version() >= 4) read_membrane(file, state.membrane);
  if (file.version() >= 5) read_cell(file, state.cell);
  state.pair_springs =
      read_contacts<PairSprings>(file, "/pair/", "id_a", "/pair_spring/",
                                 [](Extractor& from, PairSprings& pair) { walk_pair(from, pair); });
  if (file.version() >= 5) read_bonds(file, state);
  state.wall_springs = read_contacts<WallSprings>(
      file, "/wall_contact/", "grain", "/wall_spring/",
      [](Extractor& from, WallSprings& contact) { walk_wall_contact(from, contact); });
  return state;
}

}  // namespace

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  const Hdf5Reader file{path, checkpoint_kind};
  Checkpoint checkpoint;
  checkpoint.time_step = file.read<double>("/run/time_step", {1})[0];
  checkpoint.energy_at_start = file.read<double>("/run/energy_at_start", {1})[0];
  checkpoint.shape_digests =
      file.read<std::uint64_t>("/run/shape_digest", {rows_of(file, "/run/shape_digest")});
  checkpoint.acceleration_digest = file.read<std::uint64_t>("/run/acceleration_digest", {1})[0];
  const auto scene = file.read<std::uint8_t>("/run/scene", {rows_of(file, "/run/scene")});
  checkpoint.scene.assign(scene.begin(), scene.end());
  if (file.version() >= 8) {
    const std::uint64_t rows = rows_of(file, "/run/goal_met_since");
    if (rows > 1) refuse(file, "its goal is met since more than one step");
    const auto since = file.read<std::uint64_t>("/run/goal_met_since", {rows});
    if (!since.empty()) checkpoint.goal_met_since = since.front();
  }
  checkpoint.state = read_state(file, checkpoint.shape_digests.size());
  return checkpoint;
}

}  // namespace reckon
