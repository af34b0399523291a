// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <toml++/toml.h>
#include <string>
#include <vector>

#include "reckon/scene/scene_reader.hpp"

// For the sources of io alone: other headers keep the weight of toml++ out.

namespace reckon {

/// TOML text as far as it can be understood.
struct TomlSyntax {
  toml::table root;
  std::vector<SceneFault> faults;
  bool readable{false};  ///< whether `root` holds the content of the valid lines
};

/// Reads TOML and, after a fault of syntax, blanks its line and reads again, so that later faults
/// come to light too. Stops where that would only produce faults that follow from the first. When
/// the line was a table's header, `root` is of no use: its keys would seem to be another table's.
[[nodiscard]] TomlSyntax parse_toml(std::string text);

/// "a table", "a whole number": what a value is, for messages.
[[nodiscard]] std::string kind_of(const toml::node& node);

[[nodiscard]] inline SourcePosition position_of(const toml::source_region& region) {
  return {region.begin.line, region.begin.column};
}

}  // namespace reckon
