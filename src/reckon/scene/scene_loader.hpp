// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "reckon/scene/scene_reader.hpp"
#include "reckon/simulation/setup.hpp"

namespace reckon {

/// Reads the files of a scene and places its grains. What is wrong there (a damaged library, an
/// unknown shape, a text file with a bad line, a region that is too small) is added to
/// `reading.faults` at the key that names it, in order. The result may be used only when there are
/// no faults. A scene that has faults already is loaded as far as they allow.
[[nodiscard]] LoadedScene load_scene(SceneReading& reading);

}  // namespace reckon
