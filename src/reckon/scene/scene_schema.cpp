// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/scene_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <initializer_list>
#include <optional>
#include <utility>

#include "reckon/scene/scene_description.hpp"

namespace reckon {
namespace {

/// The visitor that writes down every key, walking all alternatives of default-made objects.
class Collector {
 public:
  explicit Collector(SceneSchema& schema) : schema_{schema} {}

  void number(const SceneKey& key, double& value) { add(key, "number", fmt::format("{}", value)); }
  void number(const SceneKey& key, std::optional<double>&) { add(key, "number", "none"); }
  template <std::integral Integer>
  void integer(const SceneKey& key, Integer& value) {
    add(key, "whole number", fmt::format("{}", value));
  }
  template <std::integral Integer>
  void integer(const SceneKey& key, std::optional<Integer>&) {
    add(key, "whole number", "none");
  }
  void flag(const SceneKey& key, bool& value) {
    add(key, "true or false", value ? "true" : "false");
  }
  void text(const SceneKey& key, std::string&) { add(key, "text", "none"); }
  void file(const SceneKey& key, std::string&) { add(key, "file name", "none"); }
  void vector(const SceneKey& key, Vec3& value) {
    add(key, "3 numbers", fmt::format("[{}, {}, {}]", value.x, value.y, value.z));
  }
  void vector(const SceneKey& key, std::optional<Vec3>&) { add(key, "3 numbers", "none"); }
  void quaternion(const SceneKey& key, std::vector<double>& value) {
    add(key, "4 numbers", fmt::format("[{}]", fmt::join(value, ", ")));
  }
  template <class Value, std::size_t count>
  void choice(const SceneKey& key, Value& value, const std::array<Choice<Value>, count>& choices) {
    std::string words;
    std::string standard;
    for (const auto& candidate : choices) {
      words += fmt::format("{}\"{}\"", words.empty() ? "" : ", ", candidate.word);
      if (candidate.value == value) standard = fmt::format("\"{}\"", candidate.word);
    }
    add(key, "word", standard, words);
  }
  template <class Body>
  void table(const SceneKey& key, Body&& body) {
    add(key, "table", "all defaults");
    const std::size_t own = schema_.rows.size() - 1;
    const bool outer = std::exchange(needed_, false);
    inside(std::string{key.name}, body);
    if (needed_ && !alternative_) schema_.rows[own].standard = "required";
    needed_ = outer || (needed_ && !alternative_);
  }
  template <class Value, class Body>
  void optional_table(const SceneKey& key, std::optional<Value>&, Body&& body) {
    add(key, "table", "none");
    Value value;
    const bool outer = needed_;
    inside(std::string{key.name}, [&] { body(value); });
    needed_ = outer;
  }
  template <class Value, class Body>
  void tables(const SceneKey& key, std::vector<Value>&, Body&& body) {
    add(key, "list of tables", "none");
    Value value;
    const bool outer = needed_;
    inside(std::string{key.name} + "[]", [&] { body(value); });
    needed_ = outer;
  }
  template <class Body>
  void one_of(Presence presence, std::initializer_list<std::string_view> names, std::size_t,
              Body&& body) {
    schema_.rules.push_back(
        {table_, fmt::format("{} of `{}` is given",
                             presence == Presence::exactly_one ? "exactly one" : "at most one",
                             fmt::join(names, "`, `"))});
    const bool outer = std::exchange(alternative_, presence == Presence::exactly_one);
    for (std::size_t which = 0; which < names.size(); ++which) body(which);
    alternative_ = outer;
    needed_ = needed_ || presence == Presence::exactly_one;
  }
  void rule(bool, std::initializer_list<std::string_view>, std::string_view statement,
            std::string_view = {}) {
    schema_.rules.push_back({table_, std::string{statement}});
  }
  [[nodiscard]] bool visits(bool) const { return true; }
  [[nodiscard]] bool given(std::string_view) const { return false; }

 private:
  static std::string unit_of(const SceneKey& key, std::string_view type) {
    if (!key.unit_note.empty()) return std::string{key.unit_note};
    if (key.unit.empty() && type == "whole number") return "1";
    return std::string{key.unit};
  }
  void add(const SceneKey& key, std::string_view type, std::string standard,
           std::string range = {}) {
    if (!key.standard.empty()) standard = key.standard;
    if (alternative_ && key.standard.empty()) standard = "one of several";
    if (key.required) {
      standard = "required";
      needed_ = true;
    }
    schema_.rows.push_back(
        {table_, std::string{key.name}, std::string{type}, unit_of(key, type), std::move(standard),
         range.empty() ? describe(key.range) : std::move(range), std::string{key.meaning}});
  }
  template <class Body>
  void inside(const std::string& name, Body&& body) {
    const std::string outer =
        std::exchange(table_, table_.empty() ? name : fmt::format("{}.{}", table_, name));
    const bool alternative = std::exchange(alternative_, false);
    body();
    table_ = outer;
    alternative_ = alternative;
  }

  SceneSchema& schema_;
  std::string table_;
  bool needed_{false};       // whether the current table is required
  bool alternative_{false};  // inside a choice of keys of which one is given
};

constexpr std::string_view introduction =
    R"(# Scene reference

A scene is a [TOML](https://toml.io) file that says what a run is made of. `reckon check scene.toml`
finds every fault in it and says what the run will do; `reckon run scene.toml` runs it.

```toml
title = "Sand settles in a box"

[contact]
normal_stiffness = "5e9 N/m^3"
restitution = 0.5

[body]
gravity = [0, 0, -9.81]

[[grains]]
library = "sand.h5"                 # made by: reckon grains
fill = { count = 500, box = { low = [0, 0, 0], high = ["2 cm", "2 cm", "10 cm"] } }

[[wall]]
name = "box"
box = { low = [0, 0, 0], high = ["2 cm", "2 cm", "10 cm"], open_top = true }

[time]
duration = "0.2 s"
```

**Numbers** are plain SI numbers (`0.0002`) or texts with a unit (`"0.2 mm"`), also inside vectors:
`[0, 0, "2 mm"]`. The unit must fit: a length where a length is needed. Known units: m, g, t, s, min,
h, Hz, rad, deg, rev, rpm, N, Pa, bar, J, W, L, % and their products and powers (`"kN/m^3"`,
`"m/s^2"`, `"1/s"`), with the prefixes n, u, m, c, k, M, G before m, g, s, Hz, N, Pa, J and W.

**Files** are found from the folder of the scene.

In the tables below, unit `1` is a pure number, *required* means that there is no default, and *one
of several* that exactly one of these keys must be given. A table without required keys may be left
out. This page is made by `reckon reference scene` from the same description that reads scenes.
)";
}  // namespace

std::string describe(const Range& range) {
  std::string text;
  if (range.low != -std::numeric_limits<double>::infinity()) {
    text = fmt::format("{} {}", range.low_allowed ? "at least" : "above", range.low);
  }
  if (range.high != std::numeric_limits<double>::infinity()) {
    if (!text.empty()) text += " and ";
    text += fmt::format("{} {}", range.high_allowed ? "at most" : "below", range.high);
  }
  return text;
}

std::string table_header(const std::string& table) {
  std::string name;
  for (const char letter : table) {
    if (letter != '[' && letter != ']') name += letter;
  }
  return table.ends_with("[]") ? fmt::format("[[{}]]", name) : fmt::format("[{}]", name);
}

SceneSchema scene_schema() {
  SceneSchema schema;
  Collector collector{schema};
  SceneConfig defaults;
  describe(collector, defaults);
  return schema;
}

std::string scene_reference_markdown() {
  const SceneSchema schema = scene_schema();
  std::vector<std::string> tables;  // in the order of the description
  for (const SchemaRow& row : schema.rows) {
    if (std::find(tables.begin(), tables.end(), row.table) == tables.end()) {
      tables.push_back(row.table);
    }
  }
  std::string page{introduction};
  for (const std::string& table : tables) {
    page += fmt::format("\n## {}\n\n", table.empty() ? "Top of the file" : table_header(table));
    page += "| key | type | unit | default | range | meaning |\n|---|---|---|---|---|---|\n";
    for (const SchemaRow& row : schema.rows) {
      if (row.table != table) continue;
      page += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.name, row.type,
                          row.unit.empty() ? "–" : row.unit, row.standard,
                          row.range.empty() ? "any" : row.range, row.meaning);
    }
    std::string rules;
    for (const SceneSchema::Rule& rule : schema.rules) {
      if (rule.table == table) rules += fmt::format("- {}\n", rule.text);
    }
    if (!rules.empty()) page += "\nRules:\n\n" + rules;
  }
  return page;
}

}  // namespace reckon
