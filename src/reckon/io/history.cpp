// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/io/history.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string_view>
#include <system_error>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"

namespace reckon {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string problem, std::string reason) {
  throw Error{{.place = path.string(),
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = {}}};
}

std::string header_line(const HistoryLayout& layout) {
  std::string line;
  for (const HistoryColumn& column : history_columns(layout)) {
    if (!line.empty()) line += ',';
    line += column.name;
  }
  return line + '\n';
}

std::uint64_t step_of(const std::filesystem::path& path, const std::string& line) {
  std::uint64_t step = 0;
  const auto [end, code] = std::from_chars(line.data(), line.data() + line.size(), step);
  if (code != std::errc{} || end == line.data() + line.size() || *end != ',') {
    fail(path, "a row does not begin with a step", '"' + line + '"');
  }
  return step;
}

/// The complete lines of a text, without their ends.
std::vector<std::string> complete_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out;
  std::size_t begin = 0;
  for (std::size_t end = line.find(','); end != std::string::npos; end = line.find(',', begin)) {
    out.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  out.push_back(line.substr(begin));
  return out;
}

void add_vector(std::vector<HistoryColumn>& columns, const std::string& name,
                const std::string& unit, const std::string& meaning) {
  for (const char axis : {'x', 'y', 'z'}) {
    columns.push_back({fmt::format("{}_{}{}", name, axis, unit), meaning});
  }
}
/// The six numbers of a symmetric tensor.
void add_tensor(std::vector<HistoryColumn>& columns, const std::string& name,
                const std::string& unit, const std::string& meaning) {
  for (const char* axes : {"xx", "yy", "zz", "xy", "yz", "zx"}) {
    columns.push_back({fmt::format("{}_{}{}", name, axes, unit), meaning});
  }
}
std::string tensor_cells(const Mat3& tensor) {
  const Mat3 s = symmetric_part(tensor);
  return fmt::format(",{},{},{},{},{},{}", s.row_x.x, s.row_y.y, s.row_z.z, s.row_x.y, s.row_y.z,
                     s.row_z.x);
}

void add_sample_columns(std::vector<HistoryColumn>& columns) {
  columns.push_back(
      {"volume_m3",
       "of the space that the walls close off, or of the periodic cell; 0 where it is open"});
  add_vector(columns, "size", "_m", "edges of its bounding box");
  columns.push_back({"void_ratio", "volume that is not solid over volume that is"});
  add_vector(columns, "strain", "",
             "logarithmic strain since the stage began, compression positive");
  columns.push_back({"volumetric_strain", "likewise, of the volume"});
  add_tensor(columns, "stress", "_Pa",
             "stress of Love and Weber from all contacts, compression positive, symmetric part");
  add_tensor(columns, "wall_stress", "_Pa", "the same from forces on the walls alone");
  columns.push_back({"mean_stress_Pa", "p, a third of the trace of the stress"});
  columns.push_back({"deviator_Pa", "q = sqrt(3 J2) of the stress"});
  columns.push_back(
      {"friction_angle_deg", "mobilised: sine is (sigma_1 - sigma_3) / (sigma_1 + sigma_3)"});
  columns.push_back(
      {"inertial_number", "largest rate of strain times mean diameter times sqrt(density / p)"});
  columns.push_back(
      {"mechanical_coordination", "contacts per grain over grains with at least two of them"});
  columns.push_back({"rattlers", "grains with fewer than two contacts"});
  add_tensor(columns, "contact_tensor", "", "mean of n (x) n over contact normals between grains");
  add_tensor(columns, "branch_tensor", "",
             "the same over directions from centre to centre of touching grains");
  columns.push_back({"mean_force_N", "mean contact force between grains"});
  columns.push_back({"force_variation", "standard deviation of the contact force over its mean"});
  columns.push_back({"largest_force", "largest contact force over the mean"});
}

void add_cell_columns(std::vector<HistoryColumn>& columns) {
  add_vector(columns, "cell_edge", "_m", "edges of the periodic cell along the axes");
  for (const char* axes : {"xy", "xz", "yz"}) {
    columns.push_back({fmt::format("cell_lean_{}_m", axes),
                       "how far the edge along the second axis leans along the first"});
  }
  for (const char* axes : {"xy", "xz", "yz"}) {
    columns.push_back({fmt::format("cell_shear_{}", axes),
                       "shear strain since the stage began, along the first axis across the "
                       "second"});
  }
}

std::string cell_cells(const CellState& cell) {
  const UpperMat3& edges = cell.edges;
  const Vec3 shear = cell.shear - cell.shear_at_stage_start;
  return fmt::format(",{},{},{},{},{},{},{},{},{}", edges.diagonal.x, edges.diagonal.y,
                     edges.diagonal.z, edges.xy, edges.xz, edges.yz, shear.x, shear.y, shear.z);
}

std::string sample_cells(const SampleMeasurement& s) {
  std::string cells =
      fmt::format(",{},{},{},{},{},{},{},{},{}", s.volume, s.size.x, s.size.y, s.size.z,
                  s.void_ratio, s.strain.x, s.strain.y, s.strain.z, s.volumetric_strain);
  cells += tensor_cells(s.stress) + tensor_cells(s.wall_stress);
  cells += fmt::format(",{},{},{},{},{},{}", s.invariants.mean, s.invariants.deviator,
                       s.invariants.friction_angle, s.inertial_number, s.mechanical_coordination,
                       s.rattlers);
  cells += tensor_cells(s.contact_tensor) + tensor_cells(s.branch_tensor);
  return cells + fmt::format(",{},{},{}", s.mean_force, s.force_variation, s.largest_force);
}

}  // namespace

std::vector<HistoryColumn> history_columns(const HistoryLayout& layout) {
  std::vector<HistoryColumn> columns{
      {"step", "number of steps since the start"},
      {"time_s", "simulated time"},
      {"translation_J", "kinetic energy of translation"},
      {"rotation_J", "kinetic energy of rotation"},
      {"gravity_J", "potential energy of gravity, zero at the origin"},
      {"elastic_J", "energy stored in contact springs"},
      {"friction_J", "energy lost to sliding since the start"},
      {"dashpot_J", "energy lost to contact dashpots since the start"},
      {"damping_J", "energy lost to global damping since the start"},
      {"body_work_J", "work of body forces other than gravity since the start"},
      {"wall_work_J",
       "work of moving walls, of the periodic cell and of grains with prescribed motion since the "
       "start"},
      {"departed_J", "energy that grains took along which left through an outflow"},
      {"balance_error_J",
       "stored plus lost energy minus work done, less what it was at the start: the error of time "
       "stepping"},
      {"grains", "grains in the simulation"},
      {"departed", "grains that left through an outflow since the start"},
      {"contacts", "pairs of grains that touch or are bonded"},
      {"wall_contacts", "touching pairs of grain and wall"},
      {"touching_nodes", "nodes in contact"},
      {"coordination", "contacts per grain, walls included"},
      {"unbalanced_ratio", "mean net force on a grain over mean contact force"},
      {"deepest_overlap_m", "largest penetration of a node"},
      {"largest_speed_m_per_s", "speed of the fastest grain's centre"},
      {"momentum_x_kg_m_per_s", "momentum of all grains"},
      {"momentum_y_kg_m_per_s", "momentum of all grains"},
      {"momentum_z_kg_m_per_s", "momentum of all grains"}};
  for (const Wall& wall : layout.walls) {
    for (const char axis : {'x', 'y', 'z'}) {
      columns.push_back({fmt::format("{}:f{}_N", wall.name, axis),
                         fmt::format("force of the grains on wall {}", wall.name)});
    }
  }
  if (layout.membrane) {
    columns.push_back({"membrane_pressure_Pa", "on the membrane; 0 before it is in place"});
    columns.push_back({"membrane_stretch_J",
                       "energy stored in the membrane's bonds, which "
                       "`elastic_J` holds too"});
    columns.push_back({"membrane_nodes", "nodes of the membrane that touch a grain"});
  }
  if (layout.cell) add_cell_columns(columns);
  if (layout.bonds) {
    columns.push_back({"bonds", "that hold"});
    columns.push_back({"broken_in_tension", "bonds that broke in tension since the start"});
    columns.push_back({"broken_in_shear", "bonds that broke in shear since the start"});
    columns.push_back({"fracture_J", "energy that bonds lost which broke, since the start"});
  }
  if (layout.stages) columns.push_back({"stage", "the stage under way, counted from 1"});
  if (layout.sample) add_sample_columns(columns);
  return columns;
}

std::string history_reference_markdown() {
  std::string page =
      "# Columns of history.csv\n\n"
      "One row at the start, one every `output.history_interval` steps, one at the end. The header "
      "names the columns; each name ends in its unit. Numbers are written so that they read back "
      "as the same bits. Energies add up as\n\n"
      "    translation + rotation + gravity + elastic + friction + dashpot + damping\n"
      "      + fracture + departed - body_work - wall_work = constant + balance_error\n\n"
      "Columns `membrane_...` are there where the scene has a membrane, whose contacts, energies "
      "and "
      "work of pressure the other columns include. Columns `cell_...` are there where the scene "
      "has a "
      "periodic cell; then speeds, momentum and kinetic energies are those of motion against the "
      "cell's own, and there are no forces on walls to make `wall_stress_...` of. Columns `bonds` "
      "to `fracture_J` are there where it has a `[bond]`. Column `stage` is there where the scene "
      "has "
      "stages; `volume_m3` and what follows where "
      "`output.sample` is true. The row at the last step of a stage belongs to that stage.\n\n"
      "This page is made by `reckon reference history`.\n\n"
      "| column | meaning |\n|---|---|\n";
  const Wall example{.name = "WALL", .surface = PlaneSurface{}, .law = LinearLaw{}};
  for (const HistoryColumn& column :
       history_columns({std::span{&example, 1}, true, true, true, true})) {
    page += fmt::format("| `{}` | {} |\n", column.name, column.meaning);
  }
  return page;
}

std::string history_row(const HistoryRow& told) {
  const Measurement& m = told.measurement;
  const EnergyBudget& e = m.energy;
  std::string row = fmt::format(
      "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", m.step, m.time,
      e.translation, e.rotation, e.gravity, e.elastic, e.friction, e.dashpot, e.damping,
      e.body_work, e.wall_work, e.departed, e.total() - told.energy_at_start, m.grains, m.departed,
      m.contacts, m.wall_contacts, m.touching_nodes, m.coordination, m.unbalanced_ratio,
      m.deepest_overlap, m.largest_speed, m.momentum.x, m.momentum.y, m.momentum.z);
  for (const Vec3& force : m.wall_force) {
    row += fmt::format(",{},{},{}", force.x, force.y, force.z);
  }
  if (told.membrane) {
    row += fmt::format(",{},{},{}", m.membrane_pressure, m.membrane_stretch, m.membrane_nodes);
  }
  if (told.cell != nullptr) row += cell_cells(*told.cell);
  if (told.bonds) {
    row += fmt::format(",{},{},{},{}", m.bonds, m.broken_bonds.in_tension, m.broken_bonds.in_shear,
                       e.fracture);
  }
  if (told.stage) row += fmt::format(",{}", *told.stage);
  if (told.sample != nullptr) row += sample_cells(*told.sample);
  return row;
}

HistoryFile::HistoryFile(std::filesystem::path path, const HistoryLayout& layout,
                         const std::function<bool(std::uint64_t)>& keep)
    : path_{std::move(path)} {
  const std::string header = header_line(layout);
  std::string content = header;
  if (keep) {
    const std::vector<std::string> lines = complete_lines(read_file(path_));
    if (lines.empty() || lines.front() + '\n' != header) {
      fail(path_, "has other columns than this run", "it was written for another scene");
    }
    for (std::size_t n = 1; n < lines.size(); ++n) {
      if (keep(step_of(path_, lines[n]))) content += lines[n] + '\n';
    }
  }
  write_file(path_, content);
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0) fail(path_, "cannot be opened", std::generic_category().message(errno));
}

HistoryFile::~HistoryFile() { ::close(descriptor_); }

void HistoryFile::append(const HistoryRow& row) {
  const std::string line = history_row(row) + '\n';
  const ssize_t written = ::write(descriptor_, line.data(), line.size());
  if (written != static_cast<ssize_t>(line.size())) {
    fail(path_, "a row could not be written",
         written < 0 ? std::generic_category().message(errno) : "the disk is full");
  }
}

void HistoryFile::sync() const {
  if (::fsync(descriptor_) != 0) {
    fail(path_, "could not be written", std::generic_category().message(errno));
  }
}

HistoryTable read_history(const std::filesystem::path& path) {
  const std::vector<std::string> lines = complete_lines(read_file(path));
  if (lines.empty()) fail(path, "is empty", "not even a header is there");
  HistoryTable table{cells(lines.front()), {}};
  for (std::size_t n = 1; n < lines.size(); ++n) {
    table.rows.push_back(cells(lines[n]));
    if (table.rows.back().size() != table.header.size()) {
      fail(path, fmt::format("line {} has {} cells", n + 1, table.rows.back().size()),
           fmt::format("the header has {}", table.header.size()));
    }
  }
  return table;
}

}  // namespace reckon
