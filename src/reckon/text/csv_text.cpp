// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/text/csv_text.hpp"

#include <algorithm>
#include <cstddef>

#include "reckon/core/utf8.hpp"

namespace reckon {

std::string csv_text(std::string_view name) {
  constexpr std::string_view formulas = "=+-@\t\r";
  std::string text = valid_utf8(name);
  if (!text.empty() && formulas.find(text.front()) != std::string_view::npos)
    text.insert(text.begin(), '\'');
  const bool has_blank_end = text.starts_with(' ') || text.ends_with(' ');
  if (text.find_first_of(",\"\r\n\t") == std::string::npos && !has_blank_end) return text;
  std::string quoted = "\"";
  for (const char letter : text) {
    quoted += letter;
    if (letter == '"') quoted += letter;
  }
  return quoted + '"';
}

std::vector<std::string_view> comma_separated(std::string_view line) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    parts.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace reckon
