// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "reckon/output/checkpoint.hpp"
#include "reckon/output/run_folder.hpp"
#include "reckon/run/run.hpp"
#include "reckon/simulation/setup.hpp"

namespace reckon {

/// The scene as TOML with its time step as it came out, and with its number of steps if there is
/// one.
[[nodiscard]] std::string resolved_scene(const SceneConfig& config, const PreparedScene& prepared,
                                         std::optional<std::uint64_t> steps);

/// A checkpoint of the run before its first step.
[[nodiscard]] Checkpoint first_checkpoint(const LoadedScene& scene, const PreparedScene& prepared);

/// Where a session begins.
struct RunStart {
  Checkpoint checkpoint;
  bool resumed{false};
};

/// Decides between a fresh run, which begins at `first`, and a resumed one, and makes room for it
/// in the folder. Throws Error when the folder is not free, or holds another run.
[[nodiscard]] RunStart ready_folder(const RunFolder& folder, const RunOptions& options,
                                    Checkpoint first,
                                    const std::function<void(const std::string&)>& note);

}  // namespace reckon
