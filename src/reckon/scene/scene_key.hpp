// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>
#include <variant>

#include "reckon/scene/scene_schema.hpp"

namespace reckon {

/// What a key is. `unit` is an SI unit that text/units understands.
struct SceneKey {
  std::string_view name;
  std::string_view unit{};
  Range range{};
  bool required{false};
  bool folder_allowed{false};    ///< for file: whether a folder will do
  std::string_view standard{};   ///< in words, where the default of the config is not enough
  std::string_view unit_note{};  ///< for the reference, where the unit depends on another key
  std::string_view meaning;
};

/// A word of a scene and its value.
template <class Value>
struct Choice {
  std::string_view word;
  Value value;
};
template <class Value>  // needed by compilers without the C++20 rule
Choice(std::string_view, Value)->Choice<Value>;

/// Choices of names that are kept beside what they name.
template <class Value, std::size_t count>
constexpr std::array<Choice<Value>, count> choices_of(
    const std::array<std::pair<std::string_view, Value>, count>& names) {
  std::array<Choice<Value>, count> choices{};
  for (std::size_t n = 0; n < count; ++n) choices[n] = {names[n].first, names[n].second};
  return choices;
}

/// How many of the keys of one_of must be given.
enum class Presence { exactly_one, at_most_one };

/// Makes `variant` hold a T, keeping the one that it holds already.
template <class T, class Variant>
T& hold(Variant& variant) {
  if (!std::holds_alternative<T>(variant)) variant = T{};
  return std::get<T>(variant);
}

}  // namespace reckon
