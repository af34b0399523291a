// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/text/units.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <system_error>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/text/near_misses.hpp"

namespace reckon {
namespace {

struct Symbol {
  std::string_view name;
  Unit unit;
  bool takes_prefix{false};
};

constexpr double pi = std::numbers::pi;
constexpr std::array symbols{
    Symbol{"1", {}},
    Symbol{"m", {{0, 1, 0}, 1, 0}, true},
    Symbol{"g", {{1, 0, 0}, 1, -3}, true},
    Symbol{"t", {{1, 0, 0}, 1, 3}},
    Symbol{"s", {{0, 0, 1}, 1, 0}, true},
    Symbol{"min", {{0, 0, 1}, 60, 0}},
    Symbol{"h", {{0, 0, 1}, 3600, 0}},
    Symbol{"Hz", {{0, 0, -1}, 1, 0}, true},
    Symbol{"rad", {{0, 0, 0, 1}, 1, 0}},
    Symbol{"deg", {{0, 0, 0, 1}, pi / 180, 0}},
    Symbol{"°", {{0, 0, 0, 1}, pi / 180, 0}},
    Symbol{"rev", {{0, 0, 0, 1}, 2 * pi, 0}},
    Symbol{"rpm", {{0, 0, -1, 1}, pi / 30, 0}},
    Symbol{"N", {{1, 1, -2}, 1, 0}, true},
    Symbol{"Pa", {{1, -1, -2}, 1, 0}, true},
    Symbol{"bar", {{1, -1, -2}, 1, 5}},
    Symbol{"J", {{1, 2, -2}, 1, 0}, true},
    Symbol{"W", {{1, 2, -3}, 1, 0}, true},
    Symbol{"L", {{0, 3, 0}, 1, -3}},
    Symbol{"%", {{}, 1, -2}},
};

struct Prefix {
  std::string_view name;
  int exponent;
};
constexpr std::array prefixes{Prefix{"n", -9}, Prefix{"u", -6}, Prefix{"µ", -6},
                              Prefix{"μ", -6},  // the Greek letter beside the micro sign
                              Prefix{"m", -3}, Prefix{"c", -2}, Prefix{"k", 3},
                              Prefix{"M", 6},  Prefix{"G", 9}};

[[noreturn]] void refuse(std::string problem, std::string fix = {}) {
  throw Error{{.place = {}, .problem = std::move(problem), .reason = {}, .fix = std::move(fix)}};
}

std::string quoted(std::string_view text) { return '"' + std::string{text} + '"'; }

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// `text` with plain signs in place of those that word processors set: blanks that do not break a
/// line, a minus, dots between units.
std::string with_plain_signs(std::string_view text) {
  std::string out{text};
  for (const auto& [sign, plain] :
       {std::pair{"\u00a0", ' '}, std::pair{"\u2009", ' '}, std::pair{"\u202f", ' '},
        std::pair{"\u2212", '-'}, std::pair{"\u00b7", '*'}, std::pair{"\u22c5", '*'}}) {
    const std::string_view found{sign};
    for (std::size_t at = out.find(found); at != std::string::npos; at = out.find(found, at)) {
      out.replace(at, found.size(), 1, plain);
    }
  }
  return out;
}

std::optional<Unit> find_symbol(std::string_view name) {
  // Whole names first: "min" is minutes, not milli-"in", and "Pa" no prefix at all.
  for (const Symbol& symbol : symbols) {
    if (symbol.name == name) return symbol.unit;
  }
  for (const Prefix& prefix : prefixes) {
    if (!name.starts_with(prefix.name)) continue;
    for (const Symbol& symbol : symbols) {
      if (!symbol.takes_prefix || symbol.name != name.substr(prefix.name.size())) continue;
      Unit unit = symbol.unit;
      unit.exponent += prefix.exponent;
      return unit;
    }
  }
  return std::nullopt;
}

/// Takes "^-2", "^2", "²" or "³" from the end of a factor.
int take_power(std::string_view& factor) {
  if (const auto caret = factor.find('^'); caret != std::string_view::npos) {
    const std::string_view digits = factor.substr(caret + 1);
    int power = 0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), power);
    if (code != std::errc{} || end != digits.data() + digits.size() || power < -9 || power > 9) {
      refuse(quoted(digits) + " is no power of a unit", "Write a whole number from -9 to 9.");
    }
    factor = factor.substr(0, caret);
    return power;
  }
  for (const auto& [mark, power] : {std::pair{"²", 2}, std::pair{"³", 3}}) {
    if (!factor.ends_with(mark)) continue;
    factor.remove_suffix(std::string_view{mark}.size());
    return power;
  }
  return 1;
}

void multiply(Unit& unit, const Unit& by, int power) {
  unit.dimension.mass += power * by.dimension.mass;
  unit.dimension.length += power * by.dimension.length;
  unit.dimension.time += power * by.dimension.time;
  unit.dimension.angle += power * by.dimension.angle;
  unit.exponent += power * by.exponent;
  for (int n = 0; n < std::abs(power); ++n) {
    unit.factor = power > 0 ? unit.factor * by.factor : unit.factor / by.factor;
  }
}

/// `digits` times 10^exponent, rounded once; nothing when it is not a number as a whole.
std::optional<double> scaled_decimal(std::string_view digits, int exponent) {
  const auto mark = digits.find_first_of("eE");
  if (mark != std::string_view::npos) {
    std::string_view written = digits.substr(mark + 1);
    if (written.starts_with('+')) written.remove_prefix(1);
    int power = 0;
    const auto [end, code] =
        std::from_chars(written.data(), written.data() + written.size(), power);
    if (code != std::errc{} || end != written.data() + written.size() || std::abs(power) > 9999) {
      return std::nullopt;
    }
    exponent += power;
  }
  const std::string text = std::string{digits.substr(0, mark)} + "e" + std::to_string(exponent);
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  double value = 0;
  const auto [end, code] = std::from_chars(begin, text.data() + text.size(), value);
  if (code != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

Unit parse_unit(std::string_view text) {
  Unit unit;
  int direction = 1;
  text = trimmed(text);
  while (!text.empty()) {
    const auto end = text.find_first_of("*/ ");
    std::string_view factor = text.substr(0, end);
    const std::string_view written = factor;
    const int power = take_power(factor);
    const std::optional<Unit> known = find_symbol(factor);
    if (!known) {
      const std::string advice = advice_on_unit(factor);
      refuse(factor.empty() ? "the unit has a missing part" : quoted(factor) + " is no known unit",
             !advice.empty()
                 ? advice
                 : "Units are written like \"kg/m^3\", \"kN/m\", \"mm\", \"m/s^2\", \"deg\" "
                   "or \"1/s\".");
    }
    multiply(unit, *known, direction * power);
    if (end == std::string_view::npos) break;
    // What stands between two factors: blanks and at most one sign.
    text = trimmed(text.substr(written.size()));
    direction = text.starts_with('/') ? -1 : 1;
    if (text.starts_with('/') || text.starts_with('*')) {
      text = trimmed(text.substr(1));
      if (text.empty()) refuse("the unit ends with a sign");
    }
  }
  return unit;
}

namespace {

Quantity read_quantity(std::string_view text) {
  const std::string_view whole = trimmed(text);
  const auto number_end = [&] {
    std::size_t at = whole.find_first_not_of("+-0123456789.");
    // An exponent needs a digit: the "e" of "5 e" or of a unit is none.
    if (at != std::string_view::npos && at > 0 && (whole[at] == 'e' || whole[at] == 'E')) {
      const std::size_t digit = whole.find_first_of("0123456789", at + 1);
      const std::size_t sign = whole.find_first_not_of("+-", at + 1);
      if (digit != std::string_view::npos && digit == sign) {
        at = whole.find_first_not_of("0123456789", digit);
      }
    }
    return std::min(at, whole.size());
  }();
  const std::string_view digits = whole.substr(0, number_end);
  if (digits.empty()) refuse(quoted(text) + " does not begin with a number");
  const Unit unit = parse_unit(whole.substr(number_end));
  const std::optional<double> number = scaled_decimal(digits, unit.exponent);
  if (!number) refuse(quoted(digits) + " is not a number that a double can hold");
  const double value = *number * unit.factor;
  if (!std::isfinite(value)) refuse(quoted(text) + " is too large for a double");
  return {value, unit.dimension};
}

}  // namespace

Quantity parse_quantity(std::string_view text) {
  const std::string plain = with_plain_signs(text);
  try {
    return read_quantity(plain);
  } catch (const Error&) {
    const std::string advice = advice_on_number(plain);
    if (advice.empty()) throw;
    refuse(quoted(text) + " cannot be read", advice);
  }
}

std::string describe(const Dimension& dimension) {
  std::string out;
  for (const auto& [power, name] :
       {std::pair{dimension.mass, "kg"}, std::pair{dimension.length, "m"},
        std::pair{dimension.time, "s"}, std::pair{dimension.angle, "rad"}}) {
    if (power == 0) continue;
    if (!out.empty()) out += ' ';
    out += name;
    if (power != 1) out += '^' + std::to_string(power);
  }
  return out.empty() ? "1" : out;
}

}  // namespace reckon
