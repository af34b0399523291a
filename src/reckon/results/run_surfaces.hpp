// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "reckon/avatar/shape_catalog.hpp"
#include "reckon/output/checkpoint.hpp"
#include "reckon/output/fields.hpp"
#include "reckon/output/run_folder.hpp"

namespace reckon {

/// The shapes that a checkpoint was made with, from the files that its scene names; `place` is for
/// messages. Throws Error when they are missing or have changed.
[[nodiscard]] ShapeCatalog shapes_of(const Checkpoint& checkpoint, const std::string& place);

/// The grains of a checkpoint as fields show them: in a periodic cell, their images in the cell.
[[nodiscard]] FieldsAtStep fields_of(Checkpoint checkpoint);

struct SurfaceFiles {
  std::size_t written{0};
  std::filesystem::path index;  ///< of all surface files of the run
};

/// Writes the grains' true surfaces at the checkpoints of a run, or at one of them, and an index of
/// all surface files there. Throws Error when the run, its shape library or that step is missing,
/// or when the library is no longer the one that ran, or when one file needs more memory than there
/// is. `announce` gets what a file takes before the first is made, `progressed` the number of
/// checkpoints done.
SurfaceFiles write_run_surfaces(
    const RunFolder& folder, std::optional<std::uint64_t> step,
    const std::function<void(const std::string& size)>& announce = {},
    const std::function<void(std::size_t done, std::size_t total)>& progressed = {});

}  // namespace reckon
