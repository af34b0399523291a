// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/output/history.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <iterator>
#include <limits>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include "reckon/core/error.hpp"
#include "reckon/core/file.hpp"
#include "reckon/core/write_failure.hpp"
#include "reckon/text/csv_text.hpp"
#include "reckon/text/nearest_name.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string problem, std::string reason) {
  throw Error{{.place = path.string(),
               .problem = std::move(problem),
               .reason = std::move(reason),
               .fix = {}}};
}

[[noreturn]] void refuse_header(std::string place, std::string problem) {
  throw Error{{.place = std::move(place),
               .problem = std::move(problem),
               .reason = "it was changed, or written by another version of reckon",
               .fix = "Put its header back: docs/reference/history.md lists the columns."}};
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
std::vector<std::string> complete_lines(std::string_view text) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string_view::npos;
       end = text.find('\n', begin)) {
    lines.emplace_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

std::vector<std::string> cells(std::string_view line) {
  const std::vector<std::string_view> parts = comma_separated(line);
  return {parts.begin(), parts.end()};
}

}  // namespace

std::string history_header(std::span<const HistoryQuantity> quantities) {
  std::string line;
  for (const HistoryQuantity& quantity : quantities) {
    for (const std::string& column : quantity.columns()) {
      if (!line.empty()) line += ',';
      line += column;
    }
  }
  return line;
}

std::string history_row(std::span<const HistoryQuantity> quantities, const HistoryRow& row) {
  std::string line;
  for (const HistoryQuantity& quantity : quantities) {
    for (const Number& number : quantity.numbers(row)) {
      if (!line.empty()) line += ',';
      std::visit([&](auto value) { fmt::format_to(std::back_inserter(line), "{}", value); },
                 number);
    }
  }
  return line;
}

std::string history_reference_markdown(std::span<const QuantityGroup> groups) {
  std::string page =
      "# Columns of history.csv\n\n"
      "One row at the start, one every `output.history_interval` steps, one at the end. The "
      "header\n"
      "names the columns; each name ends in its unit. Numbers are written so that they read back "
      "as\n"
      "the same bits. Energies add up as\n\n"
      "    translation + rotation + gravity + elastic + friction + dashpot + damping\n"
      "      + fracture + departed - body_work - wall_work = constant + balance_error\n\n"
      "`reckon run --json` gives the same quantities at the end of a run, and `measure()` of the\n"
      "Python package at any step, there without the units in the names.\n\n"
      "This page is made by `reckon reference history`.\n";
  for (const QuantityGroup& group : groups) {
    page += fmt::format("\n## {}\n\n", group.title);
    if (!group.condition.empty()) page += group.condition + "\n\n";
    page += "| column | unit | meaning |\n|---|---|---|\n";
    for (const HistoryQuantity& quantity : group.quantities) {
      for (const std::string& column : quantity.columns()) {
        page += fmt::format("| `{}` | {} | {} |\n", column, quantity.unit, quantity.meaning);
      }
    }
  }
  return page;
}

std::string history_reference_markdown() {
  const Wall example{.name = "WALL", .surface = PlaneSurface{}, .law = LinearLaw{}};
  return history_reference_markdown(quantity_groups({&example, 1}));
}

HistoryFile::HistoryFile(std::filesystem::path path, std::vector<HistoryQuantity> quantities,
                         const std::function<bool(std::uint64_t)>& keep)
    : path_{std::move(path)}, quantities_{std::move(quantities)} {
  const std::string header = history_header(quantities_) + '\n';
  std::string content = header;
  if (keep && std::filesystem::exists(path_)) {
    const std::vector<std::string> lines = complete_lines(read_file(path_));
    if (lines.empty() || lines.front() + '\n' != header) {
      fail(path_, "has other columns than this run",
           "it was written for another scene, or by another version of the program");
    }
    for (std::size_t n = 1; n < lines.size(); ++n) {
      if (keep(step_of(path_, lines[n]))) content += lines[n] + '\n';
    }
  }
  write_file(path_, content);
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0) throw_write_failure(path_, errno, "cannot be opened");
}

HistoryFile::~HistoryFile() { ::close(descriptor_); }

void HistoryFile::append(const HistoryRow& row) {
  const std::string line = history_row(quantities_, row) + '\n';
  const ssize_t written = ::write(descriptor_, line.data(), line.size());
  if (written != static_cast<ssize_t>(line.size())) {
    throw_write_failure(path_, written < 0 ? errno : ENOSPC, "a row could not be written");
  }
}

void HistoryFile::sync() const {
  if (::fsync(descriptor_) != 0) {
    throw_write_failure(path_, errno, "could not be written");
  }
}

HistoryTable read_history(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  const std::vector<std::string> lines = complete_lines(without_byte_order_mark(text));
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

void require_columns(const std::filesystem::path& path, const HistoryTable& history,
                     std::span<const QuantityGroup> groups) {
  std::vector<std::string> header = history.header;
  std::sort(header.begin(), header.end());
  if (const auto twice = std::adjacent_find(header.begin(), header.end()); twice != header.end()) {
    refuse_header(path.string(), fmt::format("has two columns \"{}\"", *twice));
  }
  const auto has = [&](const std::string& name) {
    return std::binary_search(header.begin(), header.end(), name);
  };
  std::set<std::string> known;
  std::vector<std::string> missing;
  for (const QuantityGroup& group : groups) {
    std::vector<std::string> columns;
    for (const HistoryQuantity& quantity : group.quantities) {
      for (std::string& column : quantity.columns()) columns.push_back(std::move(column));
    }
    known.insert(columns.begin(), columns.end());
    if (std::none_of(columns.begin(), columns.end(), has)) continue;  // the run has none of them
    std::copy_if(columns.begin(), columns.end(), std::back_inserter(missing),
                 [&](const std::string& column) { return !has(column); });
  }
  const auto is_unknown = [&](const std::string& name) { return !known.contains(name); };
  // A run of an earlier version may lack columns, and a user may add some: only both at once is a
  // change of names. No run lacks the step.
  const auto other = std::find_if(header.begin(), header.end(), is_unknown);
  if (!has("step")) refuse_header(path.string(), "has no column \"step\"");
  if (other != header.end() && !missing.empty()) {
    const std::string lost = nearest_name(*other, missing).value_or(missing.front());
    refuse_header(path.string(), fmt::format("has no column \"{}\", but one \"{}\"", lost, *other));
  }
}

double HistoryColumns::at(std::size_t row, std::string_view name) const {
  const auto column = place(name);
  if (!column) refuse_header("history.csv", fmt::format("has no column \"{}\"", name));
  const std::string& cell = history_.rows[row][*column];
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return value;
}

std::optional<std::size_t> HistoryColumns::place(std::string_view name) const {
  const auto found = std::ranges::find(history_.header, name);
  if (found == history_.header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - history_.header.begin());
}

}  // namespace reckon
