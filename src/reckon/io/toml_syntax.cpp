// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/io/toml_syntax.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace reckon {
namespace {

constexpr std::size_t most_faults = 20;

std::string with_small_initial(std::string_view text) {
  std::string out{text};
  if (!out.empty()) out[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(out[0])));
  return out;
}

/// Where a line, counted from 1, begins and ends.
struct LineRange {
  std::size_t begin;
  std::size_t end;
};
std::optional<LineRange> find_line(const std::string& text, std::uint32_t number) {
  std::size_t begin = 0;
  for (std::uint32_t line = 1; line < number; ++line) {
    begin = text.find('\n', begin);
    if (begin == std::string::npos) return std::nullopt;
    ++begin;
  }
  if (begin >= text.size()) return std::nullopt;
  return LineRange{begin, std::min(text.find('\n', begin), text.size())};
}

}  // namespace

TomlSyntax parse_toml(std::string text) {
  TomlSyntax syntax;
  std::uint32_t last_line = 0;
  bool header_lost = false;
  while (syntax.faults.size() < most_faults) {
    try {
      syntax.root = toml::parse(std::string_view{text});
      syntax.readable = !header_lost;
      return syntax;
    } catch (const toml::parse_error& error) {
      const SourcePosition position = position_of(error.source());
      if (position.line <= last_line) return syntax;
      last_line = position.line;
      syntax.faults.push_back({position, {}, with_small_initial(error.description()), {}});
    }
    const std::optional<LineRange> line = find_line(text, last_line);
    if (!line) return syntax;
    const std::size_t first = text.find_first_not_of(" \t", line->begin);
    header_lost = header_lost || (first < line->end && text[first] == '[');
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(line->begin),
              text.begin() + static_cast<std::ptrdiff_t>(line->end), ' ');
  }
  return syntax;
}

}  // namespace reckon
