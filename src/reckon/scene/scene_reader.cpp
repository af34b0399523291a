// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/scene_reader.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "reckon/core/error.hpp"
#include "reckon/scene/key_advice.hpp"
#include "reckon/scene/scene_description.hpp"
#include "reckon/scene/toml_syntax.hpp"
#include "reckon/text/near_misses.hpp"
#include "reckon/text/nearest_name.hpp"
#include "reckon/text/units.hpp"

namespace reckon {
namespace {

std::string in_unit(const SceneKey& key) {
  return key.unit == "1" ? "a number" : fmt::format("a number [{}]", key.unit);
}

/// The visitor that fills a SceneConfig from TOML and collects faults.
class Reader {
 public:
  Reader(const toml::table& root, std::filesystem::path directory, bool complete,
         SceneReading& reading)
      : directory_{std::move(directory)}, complete_{complete}, reading_{reading} {
    frames_.push_back({&root, {}, {1, 1}, {}, {}});
  }

  void finish() { report_unknown_keys(); }

  void number(const SceneKey& key, double& value) {
    if (const toml::node* node = find(key); node && !faulty(key.name)) {
      if (const auto read = to_number(key, *node)) value = *read;
    }
  }
  void number(const SceneKey& key, std::optional<double>& value) {
    double read = 0;
    const bool there = given(key.name);
    number(key, read);
    if (there && !faulty(key.name)) value = read;
  }

  template <std::integral Integer>
  void integer(const SceneKey& key, Integer& value) {
    const toml::node* node = find(key);
    if (!node) return;
    const auto* read = node->as_integer();
    if (!read) {
      return fault(key, *node, "expected a whole number, found " + kind_of(*node),
                   advice_on_integer(*node));
    }
    constexpr double most = std::min<double>(
        static_cast<double>(std::numeric_limits<Integer>::max()), static_cast<double>(INT64_MAX));
    if (!in_range(key, *node, static_cast<double>(read->get()))) return;
    if (static_cast<double>(read->get()) > most) {
      return fault(key, *node, fmt::format("{} is too large", read->get()));
    }
    value = static_cast<Integer>(read->get());
  }
  template <std::integral Integer>
  void integer(const SceneKey& key, std::optional<Integer>& value) {
    Integer read{};
    const bool there = given(key.name);
    integer(key, read);
    if (there && !faulty(key.name)) value = read;
  }

  void flag(const SceneKey& key, bool& value) {
    const toml::node* node = find(key);
    if (!node) return;
    const auto* read = node->as_boolean();
    if (!read) {
      return fault(key, *node, "expected true or false, found " + kind_of(*node),
                   "Write true or false, without quotation marks.");
    }
    value = read->get();
  }

  void text(const SceneKey& key, std::string& value) {
    const toml::node* node = find(key);
    if (!node) return;
    const auto* read = node->as_string();
    if (!read) {
      return fault(key, *node, "expected a text, found " + kind_of(*node),
                   "A text stands in quotation marks.");
    }
    value = read->get();
  }

  void file(const SceneKey& key, std::string& value) {
    std::string written;
    text(key, written);
    if (!given(key.name) || faulty(key.name)) return;
    const toml::node& node = *find(key);
    if (written.empty() || written.find('\0') != std::string::npos) {
      return fault(key, node, "is no file name");
    }
    const std::filesystem::path path = directory_ / written;
    std::error_code code;
    if (!std::filesystem::exists(path, code)) {
      return file_fault(key, node, fmt::format("there is no file \"{}\"", path.string()),
                        "Paths are relative to the folder of the scene.");
    }
    if (std::filesystem::is_directory(path, code)) {
      if (key.folder_allowed) {
        value = path.lexically_normal().string();
        return;
      }
      return file_fault(key, node, fmt::format("\"{}\" is a folder, not a file", path.string()));
    }
    if (!std::ifstream{path}) {
      return file_fault(key, node,
                        fmt::format("\"{}\" cannot be opened for reading", path.string()));
    }
    value = path.lexically_normal().string();
  }

  void vector(const SceneKey& key, Vec3& value) {
    std::array<double, 3> read{};
    if (numbers(key, read, "[x, y, z]")) value = {read[0], read[1], read[2]};
  }
  void vector(const SceneKey& key, std::optional<Vec3>& value) {
    Vec3 read;
    const bool there = given(key.name);
    vector(key, read);
    if (there && !faulty(key.name)) value = read;
  }
  void quaternion(const SceneKey& key, std::vector<double>& value) {
    std::array<double, 4> read{};
    if (!numbers(key, read, "[w, x, y, z]")) return;
    const double squared =
        read[0] * read[0] + read[1] * read[1] + read[2] * read[2] + read[3] * read[3];
    if (!(squared > 1e-200 && squared < 1e200)) {
      return fault(key, *find(key), "has no direction: its length is zero or beyond measure");
    }
    value.assign(read.begin(), read.end());
  }

  template <class Value, std::size_t count>
  void choice(const SceneKey& key, Value& value, const std::array<Choice<Value>, count>& choices) {
    std::string written;
    text(key, written);
    if (!given(key.name) || faulty(key.name)) return;
    std::vector<std::string> words;
    for (const auto& candidate : choices) {
      if (candidate.word == written) {
        value = candidate.value;
        return;
      }
      words.emplace_back(candidate.word);
    }
    const auto near = nearest_name(written, words);
    fault(key, *find(key),
          fmt::format("\"{}\" is none of \"{}\"", written, fmt::join(words, "\", \"")),
          near ? fmt::format("Did you mean \"{}\"?", *near) : "");
  }

  template <class Body>
  void table(const SceneKey& key, Body&& body) {
    const toml::node* node = find(key);
    if (node && !node->is_table()) return wrong_table(key, *node);
    enter(node ? node->as_table() : nullptr, path_of(key.name),
          node ? position_of(node->source()) : frames_.back().position);
    body();
    leave();
  }

  template <class Value, class Body>
  void optional_table(const SceneKey& key, std::optional<Value>& value, Body&& body) {
    if (!given(key.name)) {
      find(key);
      return;
    }
    value.emplace();
    table(key, [&] { body(*value); });
  }

  template <class Value, class Body>
  void tables(const SceneKey& key, std::vector<Value>& values, Body&& body) {
    const toml::node* node = find(key);
    if (!node) return;
    const toml::array* array = node->as_array();
    if (!array) return wrong_tables(key, *node);
    if (array->empty() && key.required) fault(key, *node, "is an empty list");
    for (std::size_t n = 0; n < array->size(); ++n) {
      const toml::node& element = *array->get(n);
      const std::string path = fmt::format("{}[{}]", path_of(key.name), n);
      if (!element.is_table()) {
        fault_at(position_of(element.source()), path,
                 "expected a table, found " + kind_of(element));
        continue;
      }
      enter(element.as_table(), path, position_of(element.source()));
      reading_.positions.emplace(path, frames_.back().position);
      body(values.emplace_back());
      leave();
    }
  }

  template <class Body>
  void one_of(Presence presence, std::initializer_list<std::string_view> names, std::size_t,
              Body&& body) {
    std::vector<std::size_t> there;
    std::size_t which = 0;
    for (const std::string_view name : names) {
      frames_.back().known.emplace_back(name);
      if (given(name)) there.push_back(which);
      ++which;
    }
    if (there.empty() && presence == Presence::exactly_one && complete_) {
      fault_at(frames_.back().position, frames_.back().path,
               fmt::format("needs one of `{}`", fmt::join(names, "`, `")));
    }
    const auto name = [&](std::size_t n) { return *(names.begin() + n); };
    if (there.size() > 1) {
      // The position of the one written last: the first one may be what was meant.
      std::size_t last = there[0];
      for (const std::size_t n : there) {
        if (key_position(name(n)) > key_position(name(last))) last = n;
      }
      const std::size_t first = there[0] == last ? there[1] : there[0];
      fault_at(
          key_position(name(last)), path_of(name(last)),
          fmt::format("contradicts `{}` on line {}", name(first), key_position(name(first)).line),
          fmt::format("Give only one of `{}`.", fmt::join(names, "`, `")));
    }
    for (const std::size_t n : there) body(n);
  }

  void rule(bool kept, std::initializer_list<std::string_view> names, std::string_view statement,
            std::string_view fix = {}) {
    std::string_view last;
    std::vector<std::string_view> there;
    for (const std::string_view name : names) {
      if (faulty(name)) return;
      if (!given(name)) continue;
      there.push_back(name);
      if (last.empty() || key_position(name) > key_position(last)) last = name;
    }
    if (kept || last.empty()) return;
    fault_at(key_position(last), path_of(last), std::string{statement}, std::string{fix});
    frames_.back().faulty.insert(there.begin(), there.end());
  }

  [[nodiscard]] bool visits(bool) const { return true; }
  [[nodiscard]] bool given(std::string_view name) const {
    return frames_.back().table && frames_.back().table->contains(name);
  }

 private:
  struct Frame {
    const toml::table* table;  // none: the text does not have this table
    std::string path;
    SourcePosition position;
    std::vector<std::string> known;
    std::set<std::string, std::less<>> faulty;
  };

  [[nodiscard]] std::string path_of(std::string_view name) const {
    const std::string& path = frames_.back().path;
    return path.empty() ? std::string{name} : fmt::format("{}.{}", path, name);
  }
  [[nodiscard]] bool faulty(std::string_view name) const {
    return frames_.back().faulty.contains(name);
  }
  [[nodiscard]] SourcePosition key_position(std::string_view name) const {
    return position_of(frames_.back().table->find(name)->first.source());
  }

  void fault_at(SourcePosition position, std::string key, std::string problem,
                std::string fix = {}) {
    reading_.faults.push_back({position, std::move(key), std::move(problem), std::move(fix)});
  }
  void fault(const SceneKey& key, const toml::node& node, std::string problem,
             std::string fix = {}) {
    frames_.back().faulty.emplace(key.name);
    fault_at(position_of(node.source()), path_of(key.name), std::move(problem), std::move(fix));
  }

  void file_fault(const SceneKey& key, const toml::node& node, std::string problem,
                  std::string fix = {}) {
    fault(key, node, std::move(problem), std::move(fix));
    reading_.faults.back().is_of_other_file = true;
  }

  /// The value of a key, or null. A required key that is absent is a fault.
  const toml::node* find(const SceneKey& key) {
    Frame& frame = frames_.back();
    frame.known.emplace_back(key.name);
    const toml::node* node = frame.table ? frame.table->get(key.name) : nullptr;
    if (node) {
      reading_.positions.emplace(path_of(key.name), position_of(node->source()));
    } else if (key.required && complete_ && !faulty(key.name)) {
      frame.faulty.emplace(key.name);
      fault_at(frame.position, path_of(key.name), "is missing", std::string{key.meaning});
    }
    return node;
  }

  bool in_range(const SceneKey& key, const toml::node& node, double value) {
    if (key.range.contains(value)) return true;
    fault(key, node, fmt::format("{} is out of range, must be {}", value, describe(key.range)));
    return false;
  }

  std::optional<double> to_number(const SceneKey& key, const toml::node& node) {
    std::optional<double> value;
    if (const auto* whole = node.as_integer()) value = static_cast<double>(whole->get());
    if (const auto* real = node.as_floating_point()) value = real->get();
    if (const auto* text = node.as_string()) value = to_quantity(key, node, text->get());
    if (faulty(key.name)) return std::nullopt;
    if (!value) {
      fault(key, node, fmt::format("expected {}, found {}", in_unit(key), kind_of(node)));
      return std::nullopt;
    }
    if (!std::isfinite(*value)) {
      fault(key, node, "must be a finite number");
      return std::nullopt;
    }
    return in_range(key, node, *value) ? value : std::nullopt;
  }

  std::optional<double> to_quantity(const SceneKey& key, const toml::node& node,
                                    const std::string& text) {
    try {
      const Quantity quantity = parse_quantity(text);
      const Dimension needed = parse_unit(key.unit).dimension;
      if (quantity.dimension == needed) return quantity.value;
      const std::string found = quantity.dimension == Dimension{}
                                    ? "has no unit"
                                    : "is in " + describe(quantity.dimension);
      fault(key, node, fmt::format("\"{}\" {}, but {} is needed", text, found, in_unit(key)),
            advice_on_dimension(key, quantity, text));
    } catch (const Error& error) {
      fault(key, node, fmt::format("expected {}, but {}", in_unit(key), error.text().problem),
            error.text().fix);
    }
    return std::nullopt;
  }

  static std::string advice_on_integer(const toml::node& node) {
    if (const auto* real = node.as_floating_point()) {
      return advice_on_whole_number(fmt::format("{}", real->get()));
    }
    const auto* text = node.as_string();
    const bool quoted = text && !text->get().empty() &&
                        text->get().find_first_not_of("0123456789") == std::string::npos;
    if (quoted) return fmt::format("Write {}, without quotation marks.", text->get());
    return text ? advice_on_whole_number(text->get()) : std::string{};
  }

  template <std::size_t count>
  bool numbers(const SceneKey& key, std::array<double, count>& values, std::string_view form) {
    const toml::node* node = find(key);
    if (!node) return false;
    const toml::array* array = node->as_array();
    if (!array || array->size() != count) {
      const std::string found =
          array ? fmt::format("an array of {}", array->size()) : kind_of(*node);
      std::string fix;
      if (array && array->size() > count) {
        fix = "Commas separate numbers: decimals have a point.";
      } else if (!array && count == 3) {
        fix = "Write three numbers, for example [0, 0, -9.81].";
      }
      fault(key, *node, fmt::format("expected {} numbers {}, found {}", count, form, found), fix);
      return false;
    }
    bool whole = true;
    for (std::size_t n = 0; n < count; ++n) {
      frames_.back().faulty.erase(std::string{key.name});  // so that each element is judged
      const auto value = to_number(key, *array->get(n));
      if (value) values[n] = *value;
      whole = whole && value.has_value();
    }
    if (!whole) frames_.back().faulty.emplace(key.name);
    return whole;
  }

  void wrong_table(const SceneKey& key, const toml::node& node) {
    fault(key, node, "expected a table, found " + kind_of(node),
          node.is_array() ? fmt::format("There is only one: write [{}].", path_of(key.name)) : "");
  }
  void wrong_tables(const SceneKey& key, const toml::node& node) {
    fault(key, node, "expected a list of tables, found " + kind_of(node),
          node.is_table() ? fmt::format("Write [[{}]] with double brackets.", key.name) : "");
  }

  void enter(const toml::table* table, std::string path, SourcePosition position) {
    frames_.push_back({table, std::move(path), position, {}, {}});
  }
  void leave() {
    report_unknown_keys();
    frames_.pop_back();
  }

  void report_unknown_keys() {
    const Frame& frame = frames_.back();
    if (!frame.table) return;
    for (const auto& [key, node] : *frame.table) {
      const std::string name{key.str()};
      if (std::find(frame.known.begin(), frame.known.end(), name) != frame.known.end()) continue;
      fault_at(position_of(key.source()), path_of(name), "unknown key",
               advice_on_unknown_key(name, frame.known));
    }
  }

  std::filesystem::path directory_;
  bool complete_;  // whether absent keys are surely absent
  SceneReading& reading_;
  std::vector<Frame> frames_;
};

}  // namespace

std::string describe(const SceneFault& fault, const std::string& file) {
  // A key or a value may be as long as the file.
  const auto shortened = [](const std::string& text) {
    constexpr std::size_t longest = 1000;
    return text.size() <= longest ? text : text.substr(0, longest) + "...";
  };
  std::string out = fmt::format("{}:{}:{}: ", file, fault.position.line, fault.position.column);
  if (!fault.key.empty()) out += shortened(fault.key) + ": ";
  out += shortened(fault.problem);
  if (!fault.fix.empty()) out += ". " + shortened(fault.fix);
  return out;
}

SceneReading read_scene_text(std::string_view text, const std::filesystem::path& directory) {
  SceneReading reading;
  reading.text = text;
  TomlSyntax syntax = parse_toml(reading.text);
  const bool complete = syntax.faults.empty();
  reading.faults = std::move(syntax.faults);
  if (syntax.readable) {
    Reader reader{syntax.root, directory, complete, reading};
    describe(reader, reading.config);
    reader.finish();
  }
  std::stable_sort(
      reading.faults.begin(), reading.faults.end(),
      [](const SceneFault& a, const SceneFault& b) { return a.position < b.position; });
  resolve_defaults(reading.config);
  return reading;
}

SceneReading read_scene_file(const std::filesystem::path& file) {
  std::error_code code;
  if (std::filesystem::is_directory(file, code)) {
    throw Error{{.place = file.string(),
                 .problem = "this is a folder, not a scene",
                 .reason = {},
                 .fix = "Name the TOML file in it."}};
  }
  std::ifstream stream{file, std::ios::binary};
  if (!stream) {
    throw Error{{.place = file.string(),
                 .problem = "cannot read the scene",
                 .reason = std::filesystem::exists(file, code) ? "no permission" : "no such file",
                 .fix = {}}};
  }
  const std::string text{std::istreambuf_iterator<char>{stream}, {}};
  return read_scene_text(text, std::filesystem::absolute(file).parent_path());
}

void resolve_defaults(SceneConfig& scene) {
  if (scene.contact.shear_stiffness == 0) {
    scene.contact.shear_stiffness = 0.9 * scene.contact.normal_stiffness;
  }
  for (WallConfig& wall : scene.walls) {
    if (!wall.friction) wall.friction = scene.material.friction;
    if (scene.contact.law == ContactLawKind::hertz) continue;  // has no stiffness
    if (!wall.normal_stiffness) wall.normal_stiffness = scene.contact.normal_stiffness;
    if (!wall.shear_stiffness) wall.shear_stiffness = scene.contact.shear_stiffness;
  }
}

}  // namespace reckon
