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

std::string header_line(std::span<const Wall> walls) {
  std::string line;
  for (const HistoryColumn& column : history_columns(walls)) {
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

}  // namespace

std::vector<HistoryColumn> history_columns(std::span<const Wall> walls) {
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
      {"wall_work_J", "work of moving walls and of grains with prescribed motion since the start"},
      {"departed_J", "energy that grains took along which left through an outflow"},
      {"balance_error_J",
       "stored plus lost energy minus work done, less what it was at the start: the error of time "
       "stepping"},
      {"grains", "grains in the simulation"},
      {"departed", "grains that left through an outflow since the start"},
      {"contacts", "touching pairs of grains"},
      {"wall_contacts", "touching pairs of grain and wall"},
      {"touching_nodes", "nodes in contact"},
      {"coordination", "contacts per grain, walls included"},
      {"unbalanced_ratio", "mean net force on a grain over mean contact force"},
      {"deepest_overlap_m", "largest penetration of a node"},
      {"largest_speed_m_per_s", "speed of the fastest grain's centre"},
      {"momentum_x_kg_m_per_s", "momentum of all grains"},
      {"momentum_y_kg_m_per_s", "momentum of all grains"},
      {"momentum_z_kg_m_per_s", "momentum of all grains"}};
  for (const Wall& wall : walls) {
    for (const char axis : {'x', 'y', 'z'}) {
      columns.push_back({fmt::format("{}:f{}_N", wall.name, axis),
                         fmt::format("force of the grains on wall {}", wall.name)});
    }
  }
  return columns;
}

std::string history_reference_markdown() {
  std::string page =
      "# Columns of history.csv\n\n"
      "One row at the start, one every `output.history_interval` steps, one at the end. The header "
      "names the columns; each name ends in its unit. Numbers are written so that they read back "
      "as the same bits. Energies add up as\n\n"
      "    translation + rotation + gravity + elastic + friction + dashpot + damping\n"
      "      + departed - body_work - wall_work = constant + balance_error\n\n"
      "This page is made by `reckon reference history`.\n\n"
      "| column | meaning |\n|---|---|\n";
  const Wall example{.name = "WALL", .surface = PlaneSurface{}, .law = LinearLaw{}};
  for (const HistoryColumn& column : history_columns(std::span{&example, 1})) {
    page += fmt::format("| `{}` | {} |\n", column.name, column.meaning);
  }
  return page;
}

std::string history_row(const Measurement& m, double energy_at_start) {
  const EnergyBudget& e = m.energy;
  std::string row = fmt::format(
      "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", m.step, m.time,
      e.translation, e.rotation, e.gravity, e.elastic, e.friction, e.dashpot, e.damping,
      e.body_work, e.wall_work, e.departed, e.total() - energy_at_start, m.grains, m.departed,
      m.contacts, m.wall_contacts, m.touching_nodes, m.coordination, m.unbalanced_ratio,
      m.deepest_overlap, m.largest_speed, m.momentum.x, m.momentum.y, m.momentum.z);
  for (const Vec3& force : m.wall_force) {
    row += fmt::format(",{},{},{}", force.x, force.y, force.z);
  }
  return row;
}

HistoryFile::HistoryFile(std::filesystem::path path, std::span<const Wall> walls,
                         const std::function<bool(std::uint64_t)>& keep)
    : path_{std::move(path)} {
  const std::string header = header_line(walls);
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

void HistoryFile::append(const Measurement& measurement, double energy_at_start) {
  const std::string line = history_row(measurement, energy_at_start) + '\n';
  const ssize_t written = ::write(descriptor_, line.data(), line.size());
  if (written != static_cast<ssize_t>(line.size())) {
    fail(path_, "a row could not be written",
         written < 0 ? std::generic_category().message(errno) : "the disk is full");
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
