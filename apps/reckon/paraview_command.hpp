// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon paraview: writes the grains' true paraview from checkpoints.
void add_paraview_command(CLI::App& app);

}  // namespace reckon::app
