// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "reckon/scene/scene_reader.hpp"
#include "reckon/simulation/setup.hpp"

namespace reckon::app {

/// A scene file read and loaded; `scene` may be used only if `reading.faults` is empty.
struct SceneInput {
  SceneReading reading;
  LoadedScene scene;
};

[[nodiscard]] SceneInput read_scene(const std::string& file);

/// Writes all faults to standard error as one block.
void print_faults(const std::string& file, const SceneReading& reading);

}  // namespace reckon::app
