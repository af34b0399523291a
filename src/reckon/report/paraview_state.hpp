// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "reckon/output/run_folder.hpp"

namespace reckon {

/// paraview_state.py, with @counted_from@ and @of_stage@ open.
[[nodiscard]] std::string_view paraview_state_text();

struct ParaviewState {
  std::filesystem::path script;
  std::size_t shapes{0};  ///< whose surfaces were written
  std::string missing;    ///< why there are none; empty where there are
};

/// Writes what draws a run in ParaView at once, into the folder paraview/ of the run: the shapes'
/// surfaces, of which ParaView draws one for each of its grains, and a script that opens the run's
/// files. Displacements count from the saved time at which the last stage began. Throws Error where
/// the folder holds no run, or one that has saved no grains.
[[nodiscard]] ParaviewState write_paraview_state(const RunFolder& folder);

}  // namespace reckon
