// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "reckon/output/checkpoint.hpp"
#include "reckon/output/run_folder.hpp"

namespace reckon {

/// The latest checkpoint of a folder that can be read. Damaged ones on the way are renamed to end
/// in ".damaged", and `note` reports it. Nothing when there is none.
[[nodiscard]] std::optional<Checkpoint> latest_checkpoint(
    const RunFolder& folder, const std::function<void(const std::string&)>& note);

/// Throws Error when a run may not be resumed: `now` must be the same run as `then`, but for its
/// title, its length, and how much it writes besides the history. Scenes are compared as
/// write_scene gives them; their files by the digests.
void require_same_run(const Checkpoint& then, const Checkpoint& now, const std::string& place);

}  // namespace reckon
