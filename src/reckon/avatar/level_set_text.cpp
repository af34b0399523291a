// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "reckon/avatar/level_set_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "reckon/text/text_reader.hpp"

namespace reckon {

LevelSet parse_level_set_text(std::string_view text, const std::string& name,
                              double unit_in_metres) {
  TextReader reader{text, name};
  reader.next_line();  // the comment
  reader.next_line();
  LevelSet grid;
  std::uint64_t count = 1;
  for (std::int32_t& dim : grid.dims) {
    const std::int64_t value = reader.next_integer("grid dimension");
    if (value < 2 || value > 100000) {
      reader.fail("a grid dimension is out of range",
                  fmt::format("{} was found, 2 to 100000 are allowed", value),
                  "Line 2 gives nx ny nz.");
    }
    dim = static_cast<std::int32_t>(value);
    count *= static_cast<std::uint64_t>(value);
  }
  if (count > text.size() / 2) {
    reader.fail("the file is too short for its grid", fmt::format("{} values are announced", count),
                "The file may be cut short: copy it again.");
  }
  const auto next = [&](std::string_view what) {
    return reader.to_double(reader.next_token_anywhere(), what);
  };
  grid.spacing = unit_in_metres * next("spacing");
  if (!(grid.spacing > 0)) {
    reader.fail("the spacing must be positive", fmt::format("{} m", grid.spacing),
                "Line 3 gives the spacing.");
  }
  for (int axis = 0; axis < 3; ++axis) grid.origin_body[axis] = unit_in_metres * next("origin");
  grid.values.reserve(count);
  for (std::uint64_t v = 0; v < count; ++v) {
    const double value = unit_in_metres * next("grid value");
    if (!(std::abs(value) <= std::numeric_limits<float>::max())) {
      reader.fail("a grid value is too large", fmt::format("{} m was found", value),
                  "Check the unit.");
    }
    grid.values.push_back(static_cast<float>(value));
  }
  if (const std::string_view rest = reader.next_token_anywhere(); !rest.empty()) {
    reader.fail("there is more after the last grid value", "found " + in_quotes(rest),
                "Check the grid's dimensions in line 2.");
  }
  return grid;
}

}  // namespace reckon
