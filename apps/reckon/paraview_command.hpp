// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon paraview: writes a state with which ParaView draws a run.
void add_paraview_command(CLI::App& app);

}  // namespace reckon::app
