// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/toml_syntax.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "reckon/text/near_misses.hpp"

namespace reckon {
namespace {

constexpr std::size_t most_faults = 20;

std::string with_small_initial(std::string_view text) {
  std::string out{text};
  if (!out.empty()) out[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(out[0])));
  return out;
}

/// On what the parser itself says.
std::string advice_on_description(std::string_view problem) {
  const auto says = [&](std::string_view part) {
    return problem.find(part) != std::string_view::npos;
  };
  if (says("invalid utf-8")) return "Save the file as UTF-8.";
  if (says("unknown escape sequence")) {
    return "A backslash in \"...\" begins an escape: write /, or put the text between ' and '.";
  }
  return {};
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

/// Walks the text of a TOML file and skips comments and strings of all kinds. (What is no TOML is
/// walked somehow, and refused by the parser.)
class KeyDepth {
 public:
  explicit KeyDepth(std::string_view text) : text_{text} {}

  /// Where a key has more parts than `most`: "a.b.c" has three.
  std::optional<SourcePosition> find_deeper_than(std::size_t most) {
    std::size_t parts = 1;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
        continue;
      }
      if (c == '"' || c == '\'') {
        skip_string(c);
        continue;
      }
      if (c == '.') {
        if (++parts > most) return position();
      } else if (std::string_view{"=,[]{}\n"}.find(c) != std::string_view::npos) {
        parts = 1;
      }
      ++at_;
    }
    return std::nullopt;
  }

 private:
  void skip_string(char quote) {
    const std::string three(3, quote);
    const bool has_lines = text_.substr(at_).starts_with(three);
    const std::string_view end = has_lines ? std::string_view{three} : text_.substr(at_, 1);
    at_ += end.size();
    while (at_ < text_.size() && !text_.substr(at_).starts_with(end)) {
      if (!has_lines && text_[at_] == '\n') return;
      at_ += quote == '"' && text_[at_] == '\\' ? 2U : 1U;
    }
    at_ = std::min(at_ + end.size(), text_.size());
  }
  [[nodiscard]] SourcePosition position() const {
    const std::string_view before = text_.substr(0, at_);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t begin = before.rfind('\n') + 1;  // npos + 1 is 0
    return {static_cast<std::uint32_t>(line), static_cast<std::uint32_t>(at_ - begin + 1)};
  }

  std::string_view text_;
  std::size_t at_{0};
};

}  // namespace

std::string kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

TomlSyntax parse_toml(std::string text) {
  TomlSyntax syntax;
  if (text.find('\0') != std::string::npos) {
    const bool is_utf16 = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
    syntax.faults.push_back({{},
                             {},
                             is_utf16 ? "this text is in UTF-16" : "this is not a text",
                             is_utf16 ? "Save it as UTF-8." : "Give a scene, a text in TOML."});
    return syntax;
  }
  // The parser nests a table for each part of a key and frees them by recursion.
  constexpr std::size_t most_parts = 16;
  if (const auto deep = KeyDepth{text}.find_deeper_than(most_parts)) {
    syntax.faults.push_back(
        {*deep, {}, "a key has more than 16 parts", "No key of a scene has more than four."});
    return syntax;
  }
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
    SceneFault& fault = syntax.faults.back();
    fault.fix = advice_on_description(fault.problem);
    if (fault.fix.empty()) {
      fault.fix =
          advice_on_toml_line(std::string_view{text}.substr(line->begin, line->end - line->begin));
    }
    const std::size_t first = text.find_first_not_of(" \t", line->begin);
    header_lost = header_lost || (first < line->end && text[first] == '[');
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(line->begin),
              text.begin() + static_cast<std::ptrdiff_t>(line->end), ' ');
  }
  return syntax;
}

}  // namespace reckon
