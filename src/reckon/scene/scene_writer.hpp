// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "reckon/simulation/config.hpp"

namespace reckon {

/// The scene as TOML with every default filled in, in SI units, that reads back as the same values
/// to the last bit. File names are written as they are in `scene`, so absolute paths stay good.
[[nodiscard]] std::string write_scene(SceneConfig scene);

}  // namespace reckon
