// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace CLI {
class App;
}

namespace reckon::app {

/// reckon grains: makes, describes and exports shape libraries.
void add_grains_command(CLI::App& app);

}  // namespace reckon::app
