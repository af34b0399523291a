// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/scene/scene_writer.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <concepts>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "reckon/scene/scene_description.hpp"
#include "reckon/scene/scene_reader.hpp"
#include "reckon/text/json_writer.hpp"

namespace reckon {
namespace {

/// The shortest text that reads back as `value`. TOML integers have no negative zero.
std::string toml_number(double value) {
  return value == 0 && std::signbit(value) ? "-0.0" : fmt::format("{}", value);
}

std::string toml_numbers(std::span<const double> values) {
  std::string out;
  for (const double value : values) out += (out.empty() ? "" : ", ") + toml_number(value);
  return "[" + out + "]";
}

/// The visitor that writes a scene down. Tables directly under the top get headers; deeper ones
/// use dotted keys or their own headers, whichever TOML allows.
class Writer {
 public:
  void number(const SceneKey& key, double& value) {
    line(key, toml_number(value), key.unit == "1" ? "" : key.unit);
  }
  void number(const SceneKey& key, std::optional<double>& value) {
    if (value) number(key, *value);
  }
  template <std::integral Integer>
  void integer(const SceneKey& key, Integer& value) {
    line(key, fmt::format("{}", value));
  }
  template <std::integral Integer>
  void integer(const SceneKey& key, std::optional<Integer>& value) {
    if (value) integer(key, *value);
  }
  void flag(const SceneKey& key, bool& value) { line(key, value ? "true" : "false"); }
  void text(const SceneKey& key, std::string& value) {
    if (!value.empty()) line(key, json_text(value));
  }
  void file(const SceneKey& key, std::string& value) { text(key, value); }
  void vector(const SceneKey& key, Vec3& value) {
    line(key, toml_numbers(std::array{value.x, value.y, value.z}), key.unit == "1" ? "" : key.unit);
  }
  void vector(const SceneKey& key, std::optional<Vec3>& value) {
    if (value) vector(key, *value);
  }
  void quaternion(const SceneKey& key, std::vector<double>& value) {
    line(key, toml_numbers(value));
  }
  template <class Value, std::size_t count>
  void choice(const SceneKey& key, Value& value, const std::array<Choice<Value>, count>& choices) {
    for (const auto& candidate : choices) {
      if (candidate.value == value) line(key, json_text(candidate.word));
    }
  }
  template <class Body>
  void table(const SceneKey& key, Body&& body) {
    if (header_.empty()) {
      inside(std::string{key.name}, "[{}]", body);
    } else {
      const std::string outer = std::exchange(dotted_, fmt::format("{}{}.", dotted_, key.name));
      body();
      dotted_ = outer;
    }
  }
  template <class Value, class Body>
  void optional_table(const SceneKey& key, std::optional<Value>& value, Body&& body) {
    if (value) table(key, [&] { body(*value); });
  }
  template <class Value, class Body>
  void tables(const SceneKey& key, std::vector<Value>& values, Body&& body) {
    const std::string name =
        header_.empty() ? std::string{key.name} : fmt::format("{}.{}", header_, key.name);
    for (Value& value : values) inside(name, "[[{}]]", [&] { body(value); });
  }
  template <class Body>
  void one_of(Presence, std::initializer_list<std::string_view>, std::size_t active, Body&& body) {
    body(active);
  }
  void rule(bool, std::initializer_list<std::string_view>, std::string_view,
            std::string_view = {}) {}
  [[nodiscard]] bool visits(bool matters) const { return matters; }
  [[nodiscard]] bool given(std::string_view) const { return false; }

  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  void line(const SceneKey& key, const std::string& value, std::string_view unit = {}) {
    out_ += fmt::format("{}{} = {}", dotted_, key.name, value);
    if (!unit.empty()) out_ += fmt::format("  # {}", unit);
    out_ += '\n';
  }
  template <class Body>
  void inside(const std::string& name, std::string_view form, Body&& body) {
    if (!out_.empty()) out_ += '\n';
    out_ += fmt::format(fmt::runtime(form), name) + '\n';
    const std::string outer = std::exchange(header_, name);
    body();
    header_ = outer;
  }

  std::string out_;
  std::string header_;  // of the table that lines now go to
  std::string dotted_;  // written before each key
};

}  // namespace

std::string write_scene(SceneConfig scene) {
  resolve_defaults(scene);
  Writer writer;
  describe(writer, scene);
  return writer.take();
}

}  // namespace reckon
