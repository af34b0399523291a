// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/degree_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "reckon/avatar/spherical_harmonics.hpp"
#include "reckon/text/text_reader.hpp"

namespace reckon {
namespace {

using Cells = std::vector<std::string>;

/// The cell that begins at `at`, which ends at the next separator or at the end of the line.
std::string next_cell(const TextReader& reader, std::string_view line, char separator,
                      std::size_t& at) {
  constexpr std::string_view blanks = " \t";
  const std::size_t first = line.find_first_not_of(blanks, at);
  if (first != std::string_view::npos && line[first] == '"') {
    const std::size_t close = line.find('"', first + 1);
    const std::size_t next =
        close == std::string_view::npos ? close : line.find_first_not_of(blanks, close + 1);
    if (close == std::string_view::npos ||
        (next != std::string_view::npos && line[next] != separator)) {
      reader.fail("a double quote is not closed at the end of its cell", in_quotes(line),
                  "Correct the line.");
    }
    at = next == std::string_view::npos ? line.size() + 1 : next + 1;
    return std::string{line.substr(first + 1, close - first - 1)};
  }
  const std::size_t end = std::min(line.find(separator, at), line.size());
  std::string_view cell = line.substr(at, end - at);
  at = end + 1;
  const std::size_t begin = std::min(cell.find_first_not_of(blanks), cell.size());
  cell.remove_prefix(begin);
  return std::string{cell.substr(0, cell.find_last_not_of(blanks) + 1)};
}

/// The cells of the current line; none of an empty line. Blanks never make an empty cell.
Cells cells_of(TextReader& reader, char separator) {
  Cells cells;
  if (separator == ' ') {
    for (auto token = reader.next_token(); !token.empty(); token = reader.next_token()) {
      cells.emplace_back(token);
    }
    return cells;
  }
  if (reader.rest_of_line_is_blank()) return cells;
  const std::string_view line = reader.remaining_line();
  for (std::size_t at = 0; at <= line.size();) {
    cells.push_back(next_cell(reader, line, separator, at));
  }
  return cells;
}

std::size_t column_named(const TextReader& reader, const Cells& header, const char* name) {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) {
    reader.fail("the header lacks a column", "Name and Nnn are needed",
                "Put the columns' names into the first line.");
  }
  return static_cast<std::size_t>(found - header.begin());
}

}  // namespace

std::map<std::string, std::uint32_t> parse_degree_table(std::string_view text,
                                                        const std::string& name) {
  TextReader reader{text, name};
  reader.next_line();
  const std::size_t mark = reader.remaining_line().find_first_of(",;");
  const char separator = mark == std::string_view::npos ? ' ' : reader.remaining_line()[mark];
  const Cells header = cells_of(reader, separator);
  const std::size_t name_column = column_named(reader, header, "Name");
  const std::size_t degree_column = column_named(reader, header, "Nnn");
  std::map<std::string, std::uint32_t> degrees;
  while (reader.next_line()) {
    const Cells cells = cells_of(reader, separator);
    if (cells.empty()) continue;
    if (cells.size() <= std::max(name_column, degree_column) || cells[name_column].empty()) {
      reader.fail("the line is too short", "it has no name or no degree", "Complete the table.");
    }
    if (separator != ' ' && cells.size() != header.size()) {
      reader.fail("the line does not fit the header",
                  fmt::format("it has {} cells, the header {}", cells.size(), header.size()),
                  "Correct the line.");
    }
    const std::int64_t value = reader.to_integer(cells[degree_column], "degree");
    if (value < 0 || value > SphericalHarmonicBasis::highest_degree) {
      reader.fail("the degree is out of range", in_quotes(cells[degree_column]),
                  fmt::format("It lies between 0 and {}.", SphericalHarmonicBasis::highest_degree));
    }
    const auto degree = static_cast<std::uint32_t>(value);
    if (!degrees.emplace(cells[name_column], degree).second) {
      reader.fail("a file has two lines", in_quotes(cells[name_column]), "Remove one of them.");
    }
  }
  return degrees;
}

}  // namespace reckon
