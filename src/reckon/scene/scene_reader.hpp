// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "reckon/simulation/config.hpp"

namespace reckon {

/// A place in a text file, counted from 1.
struct SourcePosition {
  std::uint32_t line{1};
  std::uint32_t column{1};
  friend constexpr auto operator<=>(const SourcePosition&, const SourcePosition&) = default;
};

/// One thing that is wrong in a scene.
struct SceneFault {
  SourcePosition position;
  std::string key;      ///< e.g. "wall[0].plane.normal"; empty for faults of TOML's own syntax
  std::string problem;  ///< what is wrong, in one clause
  std::string fix;      ///< what to do about it, as a sentence; may be empty
  bool is_of_other_file{false};  ///< the scene is right, but a file that it names cannot be read
};

/// "scene.toml:12:5: contact.law: problem. Fix."
[[nodiscard]] std::string describe(const SceneFault& fault, const std::string& file);

/// What was read, and all that is wrong with it, sorted by position. `config` may be used only
/// when there are no faults.
struct SceneReading {
  SceneConfig config;
  std::vector<SceneFault> faults;
  std::map<std::string, SourcePosition> positions;  ///< of every key that the text gives
  std::string text;                                 ///< as read
};

/// Reads a scene from TOML text. Relative paths in it are relative to `directory`; files must
/// exist there. Never throws for bad input: every fault is listed, those of the syntax too, as far
/// as reading can go on after them.
[[nodiscard]] SceneReading read_scene_text(std::string_view text,
                                           const std::filesystem::path& directory);

/// Reads a scene file. Throws Error when the file itself cannot be read.
[[nodiscard]] SceneReading read_scene_file(const std::filesystem::path& file);

/// Fills in the values that default to others, e.g. a wall's friction to the material's.
void resolve_defaults(SceneConfig& scene);

}  // namespace reckon
