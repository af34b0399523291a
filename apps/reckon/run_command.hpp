// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon run: runs a scene, or goes on with a run.
void add_run_command(CLI::App& app);

}  // namespace reckon::app
