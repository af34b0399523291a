// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace reckon {

/// The values that a key allows.
struct Range {
  double low{-std::numeric_limits<double>::infinity()};
  double high{std::numeric_limits<double>::infinity()};
  bool low_allowed{true};
  bool high_allowed{true};

  [[nodiscard]] constexpr bool contains(double value) const {
    return (low_allowed ? value >= low : value > low) &&
           (high_allowed ? value <= high : value < high);
  }
  [[nodiscard]] constexpr bool bounded() const {
    return low != -std::numeric_limits<double>::infinity() ||
           high != std::numeric_limits<double>::infinity();
  }
};

[[nodiscard]] constexpr Range above(double low) { return {.low = low, .low_allowed = false}; }
[[nodiscard]] constexpr Range at_least(double low) { return {.low = low}; }

/// "> 0", ">= 1", "0 < x <= 1"; empty without bounds.
[[nodiscard]] std::string describe(const Range& range);

/// One line of the reference: everything about one key of a scene.
struct SchemaRow {
  std::string table;     ///< "contact", "wall[]", "wall[].plane"; empty: the top of the file
  std::string name;      ///< the key in that table
  std::string type;      ///< "number", "table", ...
  std::string unit;      ///< SI unit; "1" for pure numbers, empty for what has no unit
  std::string standard;  ///< what applies when the key is absent; "required" when it may not be
  std::string range;     ///< allowed values or choices
  std::string meaning;
};

/// Everything that a scene may hold and the rules between keys, in the order of the file.
struct SceneSchema {
  struct Rule {
    std::string table;
    std::string text;
  };
  std::vector<SchemaRow> rows;
  std::vector<Rule> rules;
};

/// Built from the one description in scene_description.hpp, which also drives reading and writing.
[[nodiscard]] SceneSchema scene_schema();

/// How TOML writes a table of the schema: "[material]", "[[wall]]", "[[grains.place]]".
[[nodiscard]] std::string table_header(const std::string& table);

/// The reference page docs/reference/scene.md.
[[nodiscard]] std::string scene_reference_markdown();

}  // namespace reckon
