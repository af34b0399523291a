// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon check: finds every fault of a scene and prints what its run will do.
void add_check_command(CLI::App& app);

}  // namespace reckon::app
