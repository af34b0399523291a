// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "scene_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "reckon/core/utf8.hpp"
#include "reckon/scene/scene_loader.hpp"
#include "reckon/text/human.hpp"

namespace reckon::app {

SceneInput read_scene(const std::string& file) {
  SceneInput input;
  input.reading = read_scene_file(file);
  input.scene = load_scene(input.reading);
  return input;
}

void print_faults(const std::string& file, const SceneReading& reading) {
  constexpr std::size_t most = 100;
  const std::size_t count = reading.faults.size();
  std::string block = fmt::format("reckon: error: {} has {}\n", file, counted(count, "fault"));
  for (std::size_t n = 0; n < std::min(count, most); ++n) {
    block += "  " + describe(reading.faults[n], file) + '\n';
  }
  if (count > most) block += fmt::format("  and {} more\n", count - most);
  std::fputs(printable(block).c_str(), stderr);
}

}  // namespace reckon::app
