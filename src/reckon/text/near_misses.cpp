// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/text/near_misses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <system_error>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/text/units.hpp"

namespace reckon {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_word(char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '-'; }

std::string_view stripped(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string in_small_letters(std::string_view text) {
  std::string out{text};
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

bool all_words(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), is_word);
}

std::optional<double> whole_value(std::string_view text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  constexpr double largest = 9.2e18;
  if (code != std::errc{} || end != text.data() + text.size() || std::abs(value) > largest ||
      value != std::floor(value)) {
    return std::nullopt;
  }
  return value;
}

/// Where the number ends that begins at `at`: digits, at most one point, an exponent.
std::size_t end_of_number(std::string_view text, std::size_t at) {
  while (at < text.size() && (is_digit(text[at]) || text[at] == '.' || text[at] == '_')) ++at;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    std::size_t digit = at + 1;
    if (digit < text.size() && (text[digit] == '+' || text[digit] == '-')) ++digit;
    if (digit < text.size() && is_digit(text[digit])) {
      at = std::min(text.find_first_not_of("0123456789", digit), text.size());
    }
  }
  return at;
}

/// A line of TOML without its comment, and with blanks in place of quoted text.
struct Line {
  std::string bare;
  bool quotes_are_closed{true};
};
Line without_quoted(std::string_view line) {
  Line out;
  char quote = 0;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (quote == 0 && c == '#') break;
    if (quote == 0 && (c == '"' || c == '\'')) {
      quote = c;
      out.bare += c;
    } else if (quote != 0) {
      if (c == '\\' && quote == '"') ++at;
      if (c == quote) quote = 0;
      out.bare += quote == 0 ? c : ' ';
    } else {
      out.bare += c;
    }
  }
  out.quotes_are_closed = quote == 0;
  return out;
}

/// "0.2 mm" of `[0, 0, 0.2 mm]`: the first number that a unit follows.
std::optional<std::string> unquoted_quantity(std::string_view bare) {
  for (std::size_t at = 0; at < bare.size(); ++at) {
    if (!is_digit(bare[at]) ||
        (at > 0 && (is_word(bare[at - 1]) || bare[at - 1] == '.') && bare[at - 1] != '-')) {
      continue;
    }
    const std::size_t unit_begin = end_of_number(bare, at);
    const std::size_t end = std::min(bare.find_first_of(",]}=\"'", unit_begin), bare.size());
    const std::string_view unit = stripped(bare.substr(unit_begin, end - unit_begin));
    const bool in_key = end < bare.size() && bare[end] == '=';
    if (!unit.empty() && !in_key) {
      try {
        (void)parse_unit(unit);
        const std::size_t begin = at > 0 && bare[at - 1] == '-' ? at - 1 : at;
        return fmt::format("{} {}", bare.substr(begin, unit_begin - begin), unit);
      } catch (const Error&) {  // other text behind a number
      }
    }
    at = std::max(at, unit_begin - 1);
  }
  return std::nullopt;
}

std::string advice_on_header(std::string_view bare) {
  const auto first = bare.find_first_not_of('[');
  if (first > 2) return {};  // also where there is nothing else
  const auto last = bare.find_last_not_of(']');
  const std::string_view name = stripped(bare.substr(first, last - first + 1));
  if (name.empty() ||
      !std::all_of(name.begin(), name.end(), [](char c) { return is_word(c) || c == '.'; })) {
    return {};
  }
  return first == 2 ? fmt::format("Write [[{}]].", name) : fmt::format("Write [{}].", name);
}

std::string advice_on_key(std::string_view bare) {
  const auto colon = bare.find(':');
  if (colon != std::string_view::npos && all_words(stripped(bare.substr(0, colon)))) {
    const std::string_view value = stripped(bare.substr(colon + 1));
    return fmt::format("A key and its value are joined by `=`: write `{} = {}`.",
                       stripped(bare.substr(0, colon)), value.empty() ? "..." : value);
  }
  const auto blank = bare.find_first_of(" \t");
  if (blank != std::string_view::npos && all_words(bare.substr(0, blank))) {
    return fmt::format("A key and its value are joined by `=`: write `{} = {}`.",
                       bare.substr(0, blank), stripped(bare.substr(blank)));
  }
  return {};
}

/// On `True`, `yes` and the like.
std::string advice_on_flag(std::string_view word) {
  const std::string small = in_small_letters(word);
  if ((small == "true" || small == "false") && small != word) {
    return fmt::format("Write {} in small letters.", small);
  }
  if (small == "yes" || small == "on") return "Write true.";
  if (small == "no" || small == "off") return "Write false.";
  return {};
}

/// The same anywhere in a line: `box = { open_top = True }`.
std::string advice_on_flag_within(std::string_view bare) {
  for (std::size_t at = bare.find('='); at < bare.size(); at = bare.find('=', at + 1)) {
    const std::size_t begin = std::min(bare.find_first_not_of(" \t", at + 1), bare.size());
    const std::size_t end = std::min(bare.find_first_of(" \t,}]", begin), bare.size());
    if (std::string advice = advice_on_flag(bare.substr(begin, end - begin)); !advice.empty()) {
      return advice;
    }
  }
  return {};
}

/// On signs that TOML does not have: a minus of a word processor, `//` and `;`.
std::string advice_on_signs(std::string_view bare) {
  for (const std::string_view minus : {"\u2212", "\u2013"}) {
    if (bare.find(minus) != std::string_view::npos) return "Write a plain minus, -.";
  }
  for (const std::string_view blank : {"\u00a0", "\u2009", "\u202f"}) {
    if (bare.find(blank) != std::string_view::npos) return "Write plain blanks.";
  }
  if (bare.find("//") != std::string_view::npos && bare.find('"') > bare.find("//")) {
    return "A comment begins with #.";
  }
  if (bare.ends_with(';')) return "Leave out the `;` at the end of the line.";
  return {};
}

std::string advice_on_value(std::string_view value) {
  if (value.empty()) return "Write a value behind the `=`.";
  const std::size_t sign = value[0] == '+' || value[0] == '-' ? 1 : 0;
  const std::string_view digits = value.substr(sign);
  const std::string prefix{value.substr(0, sign == 1 && value[0] == '-' ? 1 : 0)};
  const bool starts_with_point = digits.size() > 1 && digits[0] == '.' && is_digit(digits[1]);
  if (starts_with_point) return fmt::format("Write {}0{}.", prefix, digits);
  const bool starts_with_digit = !digits.empty() && is_digit(digits[0]);
  if (starts_with_digit) {
    if (std::string advice = advice_on_number(value); !advice.empty()) return advice;
    const bool number_alone = end_of_number(digits, 0) == digits.size();
    if (number_alone && digits.back() == '.') return fmt::format("Write {}{}0.", prefix, digits);
    const auto nonzero = digits.find_first_not_of('0');
    if (number_alone && nonzero != std::string_view::npos && nonzero > 0) {
      return fmt::format("Write {}{}, without zeros in front.", prefix, digits.substr(nonzero));
    }
  }
  if (value.find_first_of(starts_with_digit ? "(*/" : "(") != std::string_view::npos) {
    return "A scene calculates nothing: write the result as a number.";
  }
  const bool may_be_text =
      is_letter(value[0]) || std::string_view{"./~"}.find(value[0]) != std::string_view::npos;
  if (may_be_text && value.find_first_of("[]{}\"'=") == std::string_view::npos) {
    return fmt::format("A text stands in quotation marks: write \"{}\".", value);
  }
  return {};
}

struct OtherName {
  std::string_view written;
  std::string_view unit;
};
constexpr std::array other_names{
    OtherName{"sec", "s"},         OtherName{"second", "s"},   OtherName{"minute", "min"},
    OtherName{"hour", "h"},        OtherName{"hr", "h"},       OtherName{"meter", "m"},
    OtherName{"metre", "m"},       OtherName{"micron", "um"},  OtherName{"millimeter", "mm"},
    OtherName{"millimetre", "mm"}, OtherName{"degree", "deg"}, OtherName{"radian", "rad"},
    OtherName{"gram", "g"},        OtherName{"newton", "N"},   OtherName{"pascal", "Pa"},
    OtherName{"hertz", "Hz"},      OtherName{"joule", "J"},    OtherName{"watt", "W"},
    OtherName{"ton", "t"},         OtherName{"tonne", "t"},    OtherName{"liter", "L"},
    OtherName{"litre", "L"},       OtherName{"percent", "%"}};
/// Units whose small letters are no other unit's: "KN", "kpa", "MM" and "Kg" can mean only these.
constexpr std::array usual_units{"mm",  "um",  "cm",  "km",  "kg",  "N",   "kN", "Pa",
                                 "kPa", "GPa", "J",   "kJ",  "ms",  "us",  "s",  "deg",
                                 "rad", "Hz",  "kHz", "bar", "rpm", "min", "L"};

bool is_unit(std::string_view text) {
  try {
    (void)parse_unit(text);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::string advice_on_number(std::string_view written) {
  const std::string_view text = stripped(written);
  std::size_t end = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  const auto digit_follows = [&] { return end + 1 < text.size() && is_digit(text[end + 1]); };
  while (end < text.size() && (is_digit(text[end]) || (std::string_view{".,' "}.find(text[end]) !=
                                                           std::string_view::npos &&
                                                       digit_follows()))) {
    ++end;
  }
  std::string number{text.substr(0, end)};
  const std::string_view unit = text.substr(end);
  const auto drop = [](std::string from, std::string_view signs) {
    std::erase_if(from, [&](char c) { return signs.find(c) != std::string_view::npos; });
    return from;
  };
  const auto count = [&](char c) { return std::count(number.begin(), number.end(), c); };
  const auto comma = number.rfind(',');
  if (comma == std::string::npos && count('\'') + count(' ') == 0) return {};
  const std::string plain = drop(number, ",' ");
  if (comma == std::string::npos || count(',') > 1 ||
      (count('.') > 0 && number.rfind('.') > comma)) {
    return fmt::format("Write {}{}, without signs between the digits.", plain, unit);
  }
  std::string decimal = drop(number.substr(0, comma), ".' ") + '.' + number.substr(comma + 1);
  constexpr std::size_t group = 3;
  const bool thousands = number.size() - comma - 1 == group && count('.') == 0 &&
                         number.find_first_of("123456789") < comma;
  return thousands ? fmt::format(
                         "Decimals have a point, and thousands no sign: write {0}{2} or "
                         "{1}{2}.",
                         decimal, plain, unit)
                   : fmt::format("Decimals have a point: write {}{}.", decimal, unit);
}

std::string advice_on_whole_number(std::string_view written) {
  const std::string_view text = stripped(written);
  std::string grouped{text};
  std::erase_if(grouped, [](char c) { return c == ',' || c == '\'' || c == ' '; });
  const auto comma = text.find(',');
  constexpr std::size_t group = 3;
  if (grouped.size() < text.size() && whole_value(grouped) &&
      (comma == std::string_view::npos || text.size() - text.rfind(',') == group + 1)) {
    return fmt::format("Write {:.0f}.", *whole_value(grouped));
  }
  if (std::string advice = advice_on_number(text); !advice.empty()) return advice;
  if (const auto value = whole_value(text)) {
    const auto point = text.find('.');  // "1.000" is one here and a thousand elsewhere
    const std::string_view digits = text.substr(0, point);
    const bool thousands = point != std::string_view::npos && text.substr(point + 1) == "000" &&
                           digits.find_first_of("123456789") != std::string_view::npos;
    return thousands ? fmt::format("Write {0} or {0}000.", digits)
                     : fmt::format("Write {:.0f}.", *value);
  }
  for (const auto& [suffix, factor] : {std::pair{"k", 1e3}, std::pair{"M", 1e6}}) {
    if (!text.ends_with(suffix)) continue;
    if (const auto value = whole_value(text.substr(0, text.size() - 1))) {
      return fmt::format("Write {:.0f}.", *value * factor);
    }
  }
  return {};
}

std::string advice_on_unit(std::string_view written) {
  const std::size_t letters = std::min(written.find_first_of("0123456789"), written.size());
  if (letters > 0 && letters < written.size() && is_unit(written.substr(0, letters))) {
    const std::string power =
        fmt::format("{}^{}", written.substr(0, letters), written.substr(letters));
    if (is_unit(power)) return fmt::format("Write \"{}\".", power);
  }
  std::string small = in_small_letters(written);
  for (const std::string_view unit : usual_units) {
    if (in_small_letters(unit) == small) return fmt::format("Write \"{}\".", unit);
  }
  if (small.size() > 3 && small.ends_with('s')) small.pop_back();
  for (const OtherName& name : other_names) {
    if (name.written == small) return fmt::format("Write \"{}\".", name.unit);
  }
  return {};
}

std::string advice_on_toml_line(std::string_view line) {
  for (const std::string_view mark : {"“", "”", "„", "‘", "’", "«", "»"}) {
    if (line.find(mark) != std::string_view::npos) {
      return "Write straight quotation marks, \" or '.";
    }
  }
  const Line read = without_quoted(line);
  if (!read.quotes_are_closed) return "A quotation mark is missing at the end of a text.";
  const std::string_view bare = stripped(read.bare);
  if (bare.starts_with('[')) {
    if (std::string advice = advice_on_header(bare); !advice.empty()) return advice;
  }
  if (std::string advice = advice_on_signs(bare); !advice.empty()) return advice;
  if (const auto quantity = unquoted_quantity(bare)) {
    return fmt::format("A number with a unit stands in quotation marks: write \"{}\".", *quantity);
  }
  const auto equals = bare.find('=');
  if (equals == std::string_view::npos) return advice_on_key(bare);
  const std::string_view key = stripped(bare.substr(0, equals));
  if (key.find(' ') != std::string_view::npos) {
    std::string joined{key};
    std::replace(joined.begin(), joined.end(), ' ', '_');
    if (all_words(joined)) return fmt::format("A key has no blanks: write `{}`.", joined);
  }
  if (std::string advice = advice_on_flag_within(bare); !advice.empty()) return advice;
  return advice_on_value(stripped(bare.substr(equals + 1)));
}

}  // namespace reckon
